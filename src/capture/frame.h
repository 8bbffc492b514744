#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "base/image.h"

namespace bole {

/// Which clock a frame's stamp was read from.
enum class StampClock : std::uint8_t { monotonic, realtime, replay };

/// When the frame was taken, by the driver's word, never the time of its arrival.
struct FrameStamp {
  StampClock clock = StampClock::monotonic;
  std::int64_t ns = 0;
};

/// One frame in its source's own buffer. Moves only; gives the buffer back when it is dropped, from
/// whatever thread that happens on. The source must outlive it.
class Frame {
 public:
  using GiveBack = std::function<void()>;

  Frame() = default;
  Frame(ImageView image, FrameStamp stamp, std::int64_t sensor_seq, GiveBack give_back)
      : image_(image), stamp_(stamp), sensor_seq_(sensor_seq), give_back_(std::move(give_back)) {}
  Frame(Frame&& other) noexcept { swap(other); }
  Frame& operator=(Frame&& other) noexcept {
    Frame(std::move(other)).swap(*this);
    return *this;
  }
  Frame(const Frame&) = delete;
  Frame& operator=(const Frame&) = delete;
  ~Frame() {
    if (give_back_) give_back_();
  }

  const ImageView& image() const { return image_; }
  FrameStamp stamp() const { return stamp_; }
  /// The driver's own count; gaps are frames lost before us.
  std::int64_t sensor_seq() const { return sensor_seq_; }
  /// In replay, the file's name without folders; else empty.
  const std::string& file() const { return file_; }
  void set_file(std::string file) { file_ = std::move(file); }

 private:
  void swap(Frame& other) noexcept {
    std::swap(image_, other.image_);
    std::swap(stamp_, other.stamp_);
    std::swap(sensor_seq_, other.sensor_seq_);
    std::swap(file_, other.file_);
    std::swap(give_back_, other.give_back_);
  }

  ImageView image_;
  FrameStamp stamp_;
  std::int64_t sensor_seq_ = 0;
  std::string file_;
  GiveBack give_back_;
};

}  // namespace bole
