#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "base/wakeup.h"
#include "service/buses.h"
#include "service/processor.h"
#include "service/service_manager.h"
#include "service/telemetry.h"
#include "service/trace.h"

namespace bole {

/// The running daemon: capture, processing and each bus in a thread of its own, one slot between
/// them, and the heartbeat in the thread that calls run().
class Pipeline {
 public:
  /// All but `publishers` must outlive the pipeline. `lockstep`: between capture, processing and
  /// buses nothing is overwritten; the faster one waits. `trace` may be null.
  Pipeline(FrameSource& source, Clock& clock, Processor& processor, Telemetry& telemetry,
           std::vector<std::unique_ptr<Publisher>> publishers, bool lockstep, Trace* trace);
  ~Pipeline();
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  /// Runs until the source ends and all that was processed is published, or until `stop_fd` becomes
  /// readable or every bus is gone.
  void run(int stop_fd);

  std::vector<bus_t> bus_health() const { return buses_.health(); }

 private:
  struct Captured {
    Frame frame;
    std::int64_t taken_ns = 0;  // CLOCK_MONOTONIC when capture handed it on
  };

  void capture();
  void process();
  void process(const Captured& captured);
  void trace(const Captured& captured, const Processor::Result& result);
  void on_camera(const CameraEvent& event);
  void waiting_for_camera();
  void publish_status(bool stopping);
  // Until then, or until something needs attention; true when `stop_fd` (-1: none) is readable.
  bool wait(int stop_fd, std::int64_t until_ns);

  FrameSource& source_;
  Clock& clock_;
  Processor& processor_;
  Telemetry& telemetry_;
  const bool lockstep_;
  const WhenFull when_full_;
  Trace* const trace_;
  ServiceManager service_manager_;
  std::vector<std::string> refused_;  // what was last told of it
  Wakeup attention_;                  // the status has changed, or a thread has ended
  std::atomic<bool> status_due_{true};
  std::atomic<bool> processing_{false};  // a frame
  std::atomic<bool> processed_all_{false};
  Supervisor supervisor_;
  Mailbox<Captured> frames_;
  Buses buses_;
  std::thread capture_thread_;
  std::thread process_thread_;
};

}  // namespace bole
