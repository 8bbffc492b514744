#include "service/trace.h"

#include <array>
#include <cstdio>
#include <span>
#include <string>

#include <spdlog/spdlog.h>

#include "base/files.h"

namespace bole {
namespace {

constexpr std::size_t kMostSpans = 200'000;
constexpr const char* kHead =
    R"([{"name":"thread_name","ph":"M","pid":1,"tid":0,"args":{"name":"capture"}},
{"name":"thread_name","ph":"M","pid":1,"tid":1,"args":{"name":"processing"}},
{"name":"thread_name","ph":"M","pid":1,"tid":2,"args":{"name":"buses"}})";

}  // namespace

Trace::Trace(std::filesystem::path file) : file_(std::move(file)) {
  write_file_atomically(file_, {});  // what cannot be written is refused now, not at the end
  spans_.reserve(kMostSpans);
}

Trace::~Trace() {
  std::string text = kHead;
  for (const Span& span : spans_) {
    std::array<char, 256> line;
    std::snprintf(line.data(), line.size(),
                  ",\n{\"name\":\"%s\",\"ph\":\"X\",\"pid\":1,\"tid\":%d,\"ts\":%.3f,\"dur\":%.3f,"
                  "\"args\":{\"seq\":%lld}}",
                  span.what, static_cast<int>(span.lane), static_cast<double>(span.start_ns) / 1e3,
                  static_cast<double>(span.end_ns - span.start_ns) / 1e3,
                  static_cast<long long>(span.seq));
    text += line.data();
  }
  text += "]\n";
  try {
    write_file_atomically(file_, std::as_bytes(std::span(text)));
  } catch (const std::exception& error) {
    spdlog::error("the trace is lost: {}", error.what());
  }
}

void Trace::record(const char* what, Lane lane, std::int64_t seq, std::int64_t start_ns,
                   std::int64_t end_ns) {
  const std::lock_guard lock(mutex_);
  if (spans_.size() < kMostSpans) spans_.push_back({what, seq, start_ns, end_ns, lane});
}

}  // namespace bole
