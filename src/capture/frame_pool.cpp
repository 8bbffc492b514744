#include "capture/frame_pool.h"

namespace bole {

int FramePool::take() {
  const std::lock_guard lock(mutex_);
  if (free_.empty()) {
    slots_.emplace_back();
    free_.reserve(slots_.size());
    return static_cast<int>(slots_.size()) - 1;
  }
  const int index = free_.back();
  free_.pop_back();
  return index;
}

FrameSlot& FramePool::slot(int index) {
  const std::lock_guard lock(mutex_);
  return slots_.at(static_cast<std::size_t>(index));
}

void FramePool::give_back(int index) noexcept {
  const std::lock_guard lock(mutex_);
  free_.push_back(index);
}

Frame FramePool::frame(int index, FrameStamp stamp, std::int64_t sensor_seq) {
  const FrameSlot& filled = slot(index);
  Frame frame(filled.view(), stamp, sensor_seq, shared_from_this(), index);
  frame.set_file(filled.file);
  return frame;
}

}  // namespace bole
