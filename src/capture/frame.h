#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>

#include "base/image.h"

namespace bole {

/// Which clock a frame's stamp was read from.
enum class StampClock : std::uint8_t { monotonic, realtime, replay };

/// When the frame was taken, by the driver's word, never the time of its arrival.
struct FrameStamp {
  StampClock clock = StampClock::monotonic;
  /// On `clock`: CLOCK_MONOTONIC, CLOCK_REALTIME, or (replay) UTC as recorded with the files.
  std::int64_t ns = 0;
  /// Replay only: the instant at which the replay let the frame happen, on the pipeline's clock.
  std::int64_t mono_ns = 0;
};

/// The buffers that a source's frames live in. Every frame shares in owning them, so that frames
/// held past the source's close() stay readable.
class FrameBuffers {
 public:
  virtual ~FrameBuffers() = default;
  /// The frame in buffer `index` was dropped: the source may fill it again. From any thread.
  virtual void give_back(int index) noexcept = 0;
};

/// One frame in its source's own buffer. Moves only; gives the buffer back when it is dropped, from
/// whatever thread that happens on.
class Frame {
 public:
  Frame() = default;
  Frame(ImageView image, FrameStamp stamp, std::int64_t sensor_seq,
        std::shared_ptr<FrameBuffers> buffers, int index)
      : image_(image),
        stamp_(stamp),
        sensor_seq_(sensor_seq),
        buffers_(std::move(buffers)),
        index_(index) {}
  Frame(Frame&& other) noexcept { swap(other); }
  Frame& operator=(Frame&& other) noexcept {
    Frame(std::move(other)).swap(*this);
    return *this;
  }
  Frame(const Frame&) = delete;
  Frame& operator=(const Frame&) = delete;
  ~Frame() {
    if (buffers_) buffers_->give_back(index_);
  }

  /// False for a frame that was never filled, or was moved from.
  explicit operator bool() const { return buffers_ != nullptr; }
  const ImageView& image() const { return image_; }
  FrameStamp stamp() const { return stamp_; }
  void set_stamp(FrameStamp stamp) { stamp_ = stamp; }
  /// The driver's own count; gaps are frames lost before us.
  std::int64_t sensor_seq() const { return sensor_seq_; }
  /// In replay, the file's name without folders; else empty. Valid as long as the frame.
  std::string_view file() const { return file_; }
  /// `file` must live as long as the frame's buffers.
  void set_file(std::string_view file) { file_ = file; }

 private:
  void swap(Frame& other) noexcept {
    std::swap(image_, other.image_);
    std::swap(stamp_, other.stamp_);
    std::swap(sensor_seq_, other.sensor_seq_);
    std::swap(file_, other.file_);
    std::swap(buffers_, other.buffers_);
    std::swap(index_, other.index_);
  }

  ImageView image_;
  FrameStamp stamp_;
  std::int64_t sensor_seq_ = 0;
  std::string_view file_;
  std::shared_ptr<FrameBuffers> buffers_;
  int index_ = 0;
};

}  // namespace bole
