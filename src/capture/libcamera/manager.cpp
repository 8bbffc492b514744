#include "capture/libcamera/manager.h"

#include <mutex>
#include <string>

#include "base/errors.h"
#include "capture/frame_source.h"

namespace bole {

std::shared_ptr<libcamera::CameraManager> camera_manager() {
  static std::mutex mutex;
  static std::weak_ptr<libcamera::CameraManager> current;
  const std::lock_guard lock(mutex);
  if (auto running = current.lock()) return running;
  auto manager = std::make_unique<libcamera::CameraManager>();
  if (const int error = manager->start(); error != 0) {
    throw CaptureError("libcamera does not start: " + error_text(-error));
  }
  std::shared_ptr<libcamera::CameraManager> shared(manager.release(),
                                                   [](libcamera::CameraManager* stopping) {
                                                     stopping->stop();
                                                     delete stopping;
                                                   });
  current = shared;
  return shared;
}

}  // namespace bole
