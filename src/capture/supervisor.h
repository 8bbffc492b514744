#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include "base/clock.h"
#include "capture/frame_source.h"

namespace bole {

/// How the camera is doing.
enum class CameraState : std::uint8_t {
  starting,   ///< nothing tried yet
  opening,    ///< being opened, or open: the first frame has not come yet
  streaming,  ///< frames arrive
  stalled,    ///< the camera is there, but frames have stopped
  no_camera,  ///< gone, or never there, or not as it must be; it is being waited for
};
std::string_view name(CameraState state);

/// A change of state, or of the reason for it.
struct CameraEvent {
  CameraState state;
  std::string reason;  ///< why it is not streaming; when it is, what it streams
  /// Told before, and neither for the 10th, the 100th, the 1000th ... time nor to say that it is
  /// over: for the status, not for the log.
  bool repeated;
  std::int64_t times = 1;  ///< that it was so since the camera last streamed well
};

/// When a camera counts as stalled and how often it is tried again.
struct SupervisorOptions {
  double stall_periods = 5;                              ///< frame periods without a frame ...
  std::chrono::nanoseconds stall_min{500'000'000};       ///< ... but not less than this
  std::chrono::nanoseconds first_frame{3'000'000'000};   ///< allowed for the first frame
  std::chrono::nanoseconds restart_min{2'000'000'000};   ///< a stalled camera is restarted
  std::chrono::nanoseconds restart_max{16'000'000'000};  ///< ever more seldom, up to this
  std::chrono::nanoseconds reopen_min{50'000'000};       ///< a missing camera is looked for
  std::chrono::nanoseconds reopen_max{200'000'000};      ///< ever more seldom, up to this
  std::chrono::nanoseconds settle{5'000'000'000};        ///< of streaming end an outage
  int unusable_frames = 5;                               ///< one after the other are as none
  std::chrono::nanoseconds tick{100'000'000};            ///< next() returns at least this often
};

/// What happened since the start.
struct CaptureCounts {
  std::int64_t frames = 0;  ///< handed out
  DropCounts drops;
  std::int64_t stamps_corrected = 0;
  std::int64_t losses = 0;    ///< times the camera went away
  std::int64_t stalls = 0;    ///< times frames stopped
  std::int64_t restarts = 0;  ///< times a stalled camera was closed and opened again
  std::int64_t failed_opens = 0;
  std::int64_t settings_refused = 0;  ///< by the camera, at all openings
};

/// Keeps a camera going: opens it, judges whether it streams, and when it stalls or goes away waits
/// for it and opens it again. The one state machine for every source. Used by one thread;
/// interrupt() may come from any.
class Supervisor {
 public:
  /// Called from within next() at each change of state or reason.
  using OnEvent = std::function<void(const CameraEvent&)>;

  /// `source` and `clock` must outlive the supervisor.
  Supervisor(FrameSource& source, Clock& clock, OnEvent on_event, SupervisorOptions options = {});
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  /// Takes one step and returns after options.tick at the latest, or once the source was opened,
  /// which tells of its own steps (FrameSource::on_step). The grab's kind is `frame`, `end`
  /// (replay only), `interrupted`, `bad_frame`, or `timeout`: nothing yet, call again; returning
  /// is progress enough for a watchdog, since the camera is then properly being waited for.
  Grab next();
  /// Makes a next() that waits, or the next one, return `interrupted`.
  void interrupt() noexcept;

  /// Tells what became of a frame later on: why it could not be used; empty when it could. Several
  /// in a row of no use are as if none had come: the camera stalls and is restarted. From any
  /// thread.
  void judged(std::string_view unusable);

  CameraState state() const { return state_; }
  const CaptureCounts& counts() const { return counts_; }

 private:
  Grab open_or_wait();
  void open();
  void wait_for_camera(const std::string& reason);
  Grab stream();
  void account(const Grab& grab);
  void streaming();
  void settle();
  std::string unusable() const;
  std::int64_t stall_after_ns() const;
  void check_stall(const std::string& bad_frame);
  void close();
  void enter(CameraState state, const std::string& reason);

  FrameSource& source_;
  Clock& clock_;
  OnEvent on_event_;
  SupervisorOptions options_;
  Wakeup interrupted_;
  CaptureCounts counts_;

  CameraState state_ = CameraState::starting;
  std::string reason_;
  std::map<std::pair<CameraState, std::string>, std::int64_t> told_;  // times in this outage
  std::int64_t streaming_since_ns_ = 0;

  mutable std::mutex judged_mutex_;  // of the two below
  int unusable_in_a_row_ = 0;
  std::string unusable_;  // why the last of them was

  bool open_ = false;
  bool got_frame_ = false;               // since it was opened
  std::int64_t last_frame_ns_ = 0;       // when it came; or when the camera was opened
  std::int64_t last_seq_ = -1;           // -1: none since it was opened
  std::int64_t unused_since_frame_ = 0;  // frames that came since, but were dropped by the source
  std::int64_t next_try_ns_ = std::numeric_limits<std::int64_t>::min();
  std::int64_t reopen_wait_ns_ = 0;
  std::int64_t restart_wait_ns_ = 0;
};

}  // namespace bole
