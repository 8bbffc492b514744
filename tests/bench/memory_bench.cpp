#include <benchmark/benchmark.h>

#include <cstring>
#include <string>
#include <vector>

namespace bole::bench {
namespace {

// What memory gives when nothing is computed: for the roofline in docs/speed.md. A frame's panorama
// and bands fit the second-level cache, a camera's buffers come from main memory.
void copy_memory(benchmark::State& state, std::size_t bytes) {
  const std::vector<char> from(bytes, 1);
  std::vector<char> to(bytes);
  for (auto _ : state) {
    std::memcpy(to.data(), from.data(), bytes);
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(2 * bytes) * state.iterations());
}

const bool registered = [] {
  for (const int kib : {256, 262144}) {
    const std::string name = "copy_memory/" + std::to_string(kib) + "KiB";
    benchmark::RegisterBenchmark(name.c_str(), copy_memory, static_cast<std::size_t>(kib) * 1024)
        ->Unit(benchmark::kMicrosecond);
  }
  return true;
}();

}  // namespace
}  // namespace bole::bench
