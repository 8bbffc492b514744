#include "capture/libcamera/session.h"

#include <libcamera/request.h>
#include <linux/dma-buf.h>
#include <sys/ioctl.h>
#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <thread>
#include <utility>

#include "base/errors.h"
#include "capture/libcamera/settings.h"

namespace bole {
namespace {

[[noreturn]] void fail(const std::string& what, int error) {
  throw CaptureError(what + ": " + error_text(error));
}

// Caches between camera and processor, where a platform needs it; elsewhere it costs nothing.
void sync(const libcamera::SharedFD& fd, std::uint64_t flags) {
  dma_buf_sync request{flags | DMA_BUF_SYNC_READ};
  while (::ioctl(fd.get(), DMA_BUF_IOCTL_SYNC, &request) != 0 && errno == EINTR) {
  }
}

}  // namespace

LibcameraSession::LibcameraSession(std::shared_ptr<libcamera::Camera> camera,
                                   libcamera::Stream* stream, const BufferLayout& layout,
                                   const libcamera::ControlList& controls)
    : camera_(std::move(camera)), unplug_watch_(camera_->id()), layout_(layout) {
  try {
    start(stream, controls);
  } catch (...) {
    end();
    throw;
  }
}

LibcameraSession::~LibcameraSession() { stop(); }

void LibcameraSession::start(libcamera::Stream* stream, const libcamera::ControlList& controls) {
  allocator_ = std::make_unique<libcamera::FrameBufferAllocator>(camera_);
  if (const int count = allocator_->allocate(stream); count < 0) fail("gives no buffers", -count);
  for (const auto& buffer : allocator_->buffers(stream)) {
    if (std::ssize(requests_) == kMaxBuffers) break;
    prepare(*buffer);
    auto request = camera_->createRequest(requests_.size());
    if (!request || request->addBuffer(stream, buffer.get()) != 0) {
      throw CaptureError("takes no request");
    }
    requests_.push_back(std::move(request));
  }
  camera_->requestCompleted.connect(this, &LibcameraSession::on_completed);
  camera_->disconnected.connect(this, &LibcameraSession::on_disconnected);
  if (const int error = camera_->start(&controls); error != 0) fail("does not start", -error);
  running_ = true;
  for (const auto& request : requests_) {
    if (const int error = camera_->queueRequest(request.get()); error != 0) {
      fail("takes no request", -error);
    }
  }
}

// Maps a buffer. Planes may lie in one dma-buf, at their offsets.
void LibcameraSession::prepare(const libcamera::FrameBuffer& buffer) {
  if (buffer.planes().size() > std::tuple_size_v<Areas> ||
      std::ssize(buffer.planes()) != layout_.memory_planes) {
    throw CaptureError("lays its frames out in an unusual way");
  }
  Areas& areas = buffers_.emplace_back();
  for (std::size_t i = 0; i < buffer.planes().size(); ++i) {
    const libcamera::FrameBuffer::Plane& plane = buffer.planes()[i];
    const std::size_t length = std::size_t{plane.offset} + plane.length;
    areas.at(i) = {plane.fd, DeviceMemory(plane.fd.get(), 0, length, PROT_READ), plane.offset};
  }
}

void LibcameraSession::on_completed(libcamera::Request* request) {
  if (request->status() == libcamera::Request::RequestCancelled) return;
  const libcamera::FrameMetadata& metadata = request->buffers().begin()->second->metadata();
  Completed completed;
  completed.index = static_cast<int>(request->cookie());
  completed.good = metadata.status == libcamera::FrameMetadata::FrameSuccess;
  completed.sequence = metadata.sequence;
  completed.stamp_ns = static_cast<std::int64_t>(metadata.timestamp);
  const auto planes = metadata.planes();
  for (std::size_t i = 0; i < std::min(planes.size(), completed.bytes.size()); ++i) {
    completed.bytes.at(i) = planes[i].bytesused;
  }
  {
    const std::lock_guard lock(posted_mutex_);
    // Every buffer has one request, so that there is always room.
    waiting_.at(static_cast<std::size_t>(waiting_count_++)) = completed;
  }
  posted_.raise();
}

void LibcameraSession::on_disconnected() {
  disconnected_ = true;
  posted_.raise();
}

void LibcameraSession::await_libcamera(std::chrono::milliseconds timeout) const {
  const auto end = std::chrono::steady_clock::now() + timeout;
  while (libcamera_lags() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

int LibcameraSession::take(std::span<Completed, kMaxBuffers> completed) {
  posted_.take();
  const std::lock_guard lock(posted_mutex_);
  std::copy_n(waiting_.begin(), waiting_count_, completed.begin());
  return std::exchange(waiting_count_, 0);
}

std::optional<ImageView> LibcameraSession::view(const Completed& completed) const {
  const Areas& areas = buffers_.at(static_cast<std::size_t>(completed.index));
  std::array<std::span<const std::byte>, 2> filled;
  for (std::size_t i = 0; i < areas.size(); ++i) {
    const Area& area = areas.at(i);
    const std::span<const std::byte> mapped = area.mapped.bytes();
    if (mapped.empty()) continue;
    sync(area.fd, DMA_BUF_SYNC_START);
    const std::size_t room = mapped.size() - area.offset;
    filled.at(i) = mapped.subspan(area.offset, std::min(completed.bytes.at(i), room));
  }
  return view_buffer(layout_, filled);
}

void LibcameraSession::give_back(int index) noexcept {
  const auto at = static_cast<std::size_t>(index);
  for (const Area& area : buffers_[at]) {
    if (!area.mapped.bytes().empty()) sync(area.fd, DMA_BUF_SYNC_END);
  }
  const std::lock_guard lock(running_mutex_);
  if (!running_) return;
  libcamera::Request& request = *requests_[at];
  request.reuse(libcamera::Request::ReuseBuffers);
  if (const int exposure_us = exposure_us_.exchange(0); exposure_us > 0) {
    set_exposure(request.controls(), exposure_us);
  }
  // A refusal means that the camera is gone, which `disconnected` tells.
  camera_->queueRequest(&request);
}

void LibcameraSession::stop() noexcept {
  const std::lock_guard lock(running_mutex_);
  end();
}

void LibcameraSession::end() noexcept {
  if (!camera_) return;
  if (running_) camera_->stop();
  running_ = false;
  camera_->requestCompleted.disconnect(this);
  camera_->disconnected.disconnect(this);
  requests_.clear();
  allocator_.reset();
  camera_->release();
  camera_.reset();
}

}  // namespace bole
