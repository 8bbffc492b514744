#pragma once

#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "capture/replay/replay_source.h"
#include "support/config_problem.h"
#include "support/temporary_folder.h"

namespace bole::test {

constexpr ImageSize kSize{4, 2};

inline std::string grey_pixels(char value) { return std::string(8, value); }

inline ReplayOptions options_for(const std::filesystem::path& path,
                                 ReplayPace::Kind pace = ReplayPace::Kind::lockstep) {
  ReplayOptions options;
  options.path = path;
  options.size = kSize;
  options.pace.kind = pace;
  return options;
}

struct Seen {
  std::string file;
  std::int64_t seq;
  std::int64_t utime_us;
  std::string bytes;
};

inline std::string bytes_of(const Frame& frame) {
  const std::span<const std::byte> bytes = frame.image().planes[0].bytes;
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

struct Replayed {
  std::vector<Seen> frames;
  std::vector<std::string> bad;
  std::int64_t superseded = 0;
};

// Grabs until the end, or `most` frames.
inline Replayed replay(const ReplayOptions& options, std::size_t most = 1000) {
  ReplayClock clock;
  const auto source = make_replay_source(options, clock);
  source->open();
  Replayed seen;
  while (seen.frames.size() < most) {
    const Grab grab = source->grab(std::chrono::seconds(1));
    seen.superseded += grab.drops[DropCause::superseded];
    if (grab.kind == Grab::Kind::end) break;
    if (grab.kind == Grab::Kind::bad_frame) seen.bad.push_back(grab.reason);
    if (grab.kind != Grab::Kind::frame) continue;
    seen.frames.push_back({std::string(grab.frame.file()), grab.frame.sensor_seq(),
                           grab.frame.stamp().ns / 1000, bytes_of(grab.frame)});
  }
  return seen;
}

inline std::vector<std::string> files_of(const Replayed& seen) {
  std::vector<std::string> files;
  for (const Seen& frame : seen.frames) files.push_back(frame.file);
  return files;
}

inline std::vector<std::int64_t> utimes_of(const Replayed& seen) {
  std::vector<std::int64_t> utimes;
  for (const Seen& frame : seen.frames) utimes.push_back(frame.utime_us);
  return utimes;
}

inline std::string refusal(const ReplayOptions& options) {
  ReplayClock clock;
  return config_problem([&] { make_replay_source(options, clock); });
}

inline TemporaryFolder folder_of(int frames) {
  TemporaryFolder folder;
  for (int i = 0; i < frames; ++i) {
    folder.write("f" + std::to_string(i) + ".grey", grey_pixels(static_cast<char>('a' + i)));
  }
  return folder;
}

}  // namespace bole::test
