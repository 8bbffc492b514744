#include "video_stream.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "descriptors.h"
#include "events.h"

namespace hil {
namespace {

// Payload header, bmHeaderInfo (UVC 1.1 section 2.4.3.3).
constexpr unsigned kHeaderSize = 2;
constexpr unsigned kEndOfFrame = 1u << 1;
constexpr unsigned kError = 1u << 6;
constexpr unsigned kEndOfHeader = 1u << 7;

}  // namespace

void VideoStream::start(const FrameSize& size, std::chrono::nanoseconds interval) {
  const std::lock_guard lock(mutex_);
  size_ = &size;
  interval_ = interval;
  due_ = Clock::now();
  frame_count_ = 0;
  ++stream_;
  changed_.notify_all();
}

void VideoStream::stop() {
  const std::lock_guard lock(mutex_);
  if (size_ == nullptr) return;
  size_ = nullptr;
  ++stream_;
  changed_.notify_all();
  Event("stopped");
}

void VideoStream::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  changed_.notify_all();
}

void VideoStream::submit(Submit submit) {
  const std::lock_guard lock(mutex_);
  waiting_.push_back(std::move(submit));
  changed_.notify_all();
}

void VideoStream::unlink(const Unlink& unlink) {
  const std::lock_guard lock(mutex_);
  const auto removed = std::erase_if(
      waiting_, [&](const Submit& submit) { return submit.sequence == unlink.victim; });
  link_.answer(unlink, removed ? -ECONNRESET : 0);
}

void VideoStream::answer_control(const Submit& submit, int status, std::span<const uint8_t> data) {
  const std::lock_guard lock(mutex_);
  const auto actual = submit.device_to_host ? data.size() : submit.data.size();
  link_.answer(submit, status, data, status == 0 ? static_cast<uint32_t>(actual) : 0);
}

void VideoStream::change_faults(const std::function<void(StreamFaults&)>& change) {
  const std::lock_guard lock(mutex_);
  change(faults_);
  changed_.notify_all();
}

StreamFaults VideoStream::faults() const {
  const std::lock_guard lock(mutex_);
  return faults_;
}

void VideoStream::run() {
  while (const auto picture = wait_for_next()) {
    if (send(*picture)) {
      Event("frame").add("index", picture->index).add("bytes", picture->bytes.size());
    }
  }
}

// Waits until the next frame is due and may be sent; nothing once closed.
std::optional<VideoStream::Picture> VideoStream::wait_for_next() {
  std::unique_lock lock(mutex_);
  while (!closed_) {
    if (size_ == nullptr || waiting_.empty() || faults_.frames_allowed == 0) {
      changed_.wait(lock);
      continue;
    }
    if (Clock::now() < due_) {
      changed_.wait_until(lock, due_);
      continue;
    }
    // A camera that was held up goes on at its rate; it does not make up for what it missed.
    due_ = std::max(due_ + interval_, Clock::now());
    if (faults_.frames_allowed != StreamFaults::kUnlimited) --faults_.frames_allowed;

    Picture picture{};
    picture.index = frame_count_ % size_->frames.size();
    picture.bytes = size_->frames[picture.index];
    picture.parity = frame_count_ % 2;
    picture.stream = stream_;
    ++frame_count_;
    if (faults_.frames_to_shorten > 0) {
      --faults_.frames_to_shorten;
      picture.bytes = picture.bytes.first(picture.bytes.size() / 2);
    }
    if (faults_.frames_to_mark > 0) {
      --faults_.frames_to_mark;
      picture.marked = true;
    }
    return picture;
  }
  return std::nullopt;
}

// False if the stream ended in the middle of the frame.
bool VideoStream::send(const Picture& picture) {
  std::span<const uint8_t> rest = picture.bytes;
  while (!rest.empty()) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !current(picture) || !waiting_.empty(); });
    if (!current(picture)) return false;
    const Submit submit = std::move(waiting_.front());
    waiting_.pop_front();

    const size_t room = std::min(submit.length, kMaxPayloadBytes) - kHeaderSize;
    const auto part = rest.first(std::min(room, rest.size()));
    rest = rest.subspan(part.size());
    const unsigned info = picture.parity | kEndOfHeader | (rest.empty() ? kEndOfFrame : 0) |
                          (picture.marked ? kError : 0);
    const Bytes payload = ByteWriter().u8({kHeaderSize, info}).append(part).take();
    if (!link_.answer(submit, 0, payload, static_cast<uint32_t>(payload.size()))) return false;
  }
  return true;
}

}  // namespace hil
