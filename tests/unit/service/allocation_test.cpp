// A program of its own: it counts every allocation that C++ makes on the heap.

#include <atomic>
#include <cstdlib>
#include <new>
#include <random>

#include <gtest/gtest.h>

#include "service/buses.h"
#include "service/processor.h"

namespace {
std::atomic<bool> counting{false};
std::atomic<std::int64_t> allocations{0};
}  // namespace

// Out of line, or the compiler sees malloc and free where it expects new and delete.
[[gnu::noinline]] void* operator new(std::size_t size) {
  if (counting) ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t /*size*/) noexcept {
  std::free(memory);
}

[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  if (counting) ++allocations;
  const auto whole = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(whole, (size + whole - 1) / whole * whole)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t /*alignment*/) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t /*size*/,
                                       std::align_val_t /*alignment*/) noexcept {
  std::free(memory);
}

namespace bole {
namespace {

class NoBuffers : public FrameBuffers {
 public:
  void give_back(int /*index*/) noexcept override {}
};

class QuietBus : public Publisher {
 public:
  std::string name() const override { return "quiet"; }
  void publish(MessageKind /*kind*/, std::span<const std::byte> /*bytes*/,
               const std::string& /*file*/) override {}
};

class Allocation : public testing::TestWithParam<DetectorMode> {};

// From the frame to the bytes that a bus is given.
TEST_P(Allocation, NoneAFrameAfterTheFirstHundred) {
  const Camera camera = load_camera(std::string(BOLE_SOURCE_DIR) + "/calib/example/camera.toml");
  const WarpTable table = build_warp_table(camera);
  const SystemClock clock;
  ProcessorOptions options;
  options.mode = GetParam();
  options.min_score = 0;
  options.camera = "sixteen-letters-";
  Processor processor(table, camera.config.mount.height, camera.config.search, options, clock);
  std::vector<std::unique_ptr<Publisher>> publishers;
  publishers.push_back(std::make_unique<QuietBus>());
  Buses buses(std::move(publishers), WhenFull::wait, [] {});

  const ImageSize size = camera.model->image_size();
  std::vector<std::byte> pixels(packed_frame_bytes(PixelFormat::yuyv, size));
  std::mt19937 random(1);
  const auto buffers = std::make_shared<NoBuffers>();
  for (int k = 0; k < 120; ++k) {
    // Ever new dark and bright bars, so that there is something to find.
    const std::size_t period = 20 + random() % 40;
    for (std::size_t i = 0; i < pixels.size(); i += 2) {
      pixels[i] = static_cast<std::byte>((i / 2 / period) % 2 == 0 ? 40 : 180);
    }
    counting = k >= 100;
    {
      const Frame frame(*view_packed(PixelFormat::yuyv, size, pixels),
                        {StampClock::monotonic, k * 100'000'000LL, 0}, k, buffers, 0);
      const Processor::Result result = processor.process(frame);
      buses.offer(MessageKind::trees, result.bytes, "frame_000001.jpg", clock.mono_ns());
    }
    counting = false;
  }
  EXPECT_EQ(allocations, 0);
}

INSTANTIATE_TEST_SUITE_P(Modes, Allocation,
                         testing::Values(DetectorMode::paper, DetectorMode::bole));

}  // namespace
}  // namespace bole
