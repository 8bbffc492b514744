// What happens in the camera, one JSON object a line on standard output: the tests wait for these.
#pragma once

#include <time.h>
#include <concepts>
#include <cstdio>
#include <string>
#include <string_view>

namespace hil {

/// Collects fields; written as one line when it goes out of scope. Names and texts are the rig's
/// own and need no escaping.
class Event {
 public:
  explicit Event(std::string_view name) {
    timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    char time[40];
    std::snprintf(time, sizeof time, "%lld.%06ld", static_cast<long long>(now.tv_sec),
                  now.tv_nsec / 1000);
    line_.append("{\"time\":").append(time).append(",\"event\":\"").append(name).append("\"");
  }
  ~Event() {
    line_.append("}\n");
    std::fwrite(line_.data(), 1, line_.size(), stdout);  // one call: lines of threads do not mix
    std::fflush(stdout);
  }
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;

  Event& add(std::string_view key, std::integral auto value) {
    line_.append(",\"").append(key).append("\":").append(std::to_string(value));
    return *this;
  }
  Event& add(std::string_view key, std::string_view text) {
    line_.append(",\"").append(key).append("\":\"").append(text).append("\"");
    return *this;
  }

 private:
  std::string line_;
};

}  // namespace hil
