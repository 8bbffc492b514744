#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <random>
#include <thread>
#include <vector>

namespace bole::bench {

/// A frame that is worked on thirty times a second costs more than one that follows on another: in
/// between others have the caches, and the frame itself comes from main memory.
inline constexpr std::chrono::milliseconds kPause{33};
inline constexpr std::size_t kRing = 40;  ///< frames; of YUYV 98 MB, more than a cache holds

/// kRing frames like `frame`, each with a noise of its own.
inline std::vector<std::vector<std::byte>> ring_of(const std::vector<std::byte>& frame) {
  std::vector<std::vector<std::byte>> ring(kRing, frame);
  std::minstd_rand random(1);
  for (auto& bytes : ring) {
    for (std::byte& byte : bytes) {
      const int level = std::to_integer<int>(byte) + static_cast<int>(random() >> 8) % 5 - 2;
      byte = static_cast<std::byte>(std::clamp(level, 0, 255));
    }
  }
  return ring;
}

/// Does the work of frame 0, 1 .. kRing - 1, 0 .. with a pause before each; only the work is timed.
template <class Work>
void pace(benchmark::State& state, const Work& work) {
  std::size_t frame = 0;
  for (auto _ : state) {
    state.PauseTiming();
    std::this_thread::sleep_for(kPause);
    state.ResumeTiming();
    work(frame++ % kRing);
  }
}

}  // namespace bole::bench
