#pragma once

#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "capture/frame.h"

namespace bole {

/// One image in memory of its own, tightly packed.
struct FrameSlot {
  PixelFormat format = PixelFormat::grey;
  ImageSize size;
  std::vector<std::byte> bytes;
  std::string file;  ///< name without folders

  /// The bytes must suffice for the format and the size.
  ImageView view() const { return view_packed(format, size, bytes).value(); }
};

/// Frames in ordinary memory that is used again and again; as many slots as are in use at once.
class FramePool : public FrameBuffers, public std::enable_shared_from_this<FramePool> {
 public:
  static std::shared_ptr<FramePool> make() { return std::make_shared<FramePool>(); }

  /// A free slot, to be filled and then either made a frame or given back.
  int take();
  FrameSlot& slot(int index);
  void give_back(int index) noexcept override;
  /// The filled slot as a frame. The slot's bytes must suffice for its format and size.
  Frame frame(int index, FrameStamp stamp, std::int64_t sensor_seq);

 private:
  std::mutex mutex_;
  std::deque<FrameSlot> slots_;  // stay where they are as the deque grows
  std::vector<int> free_;        // capacity for all of slots_
};

}  // namespace bole
