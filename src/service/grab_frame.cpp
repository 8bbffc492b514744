#include "service/grab_frame.h"

#include <utility>
#include <vector>

#include "base/files.h"
#include "service/make_source.h"

namespace bole {
namespace {

constexpr int kFramesToSettle = 5;
constexpr std::int64_t kPatienceNs = 10'000'000'000;

// The source, closed at the end.
class Opened {
 public:
  explicit Opened(FrameSource& source) : source_(source) { source_.open(); }
  Opened(const Opened&) = delete;
  Opened& operator=(const Opened&) = delete;
  ~Opened() { source_.close(); }

 private:
  FrameSource& source_;
};

Frame take_frame(FrameSource& source, const Clock& clock) {
  const std::int64_t deadline_ns = clock.mono_ns() + kPatienceNs;
  Frame frame;
  std::string trouble = "none came";
  for (int taken = 0; taken < kFramesToSettle && clock.mono_ns() < deadline_ns;) {
    Grab grab = source.grab(std::chrono::nanoseconds(deadline_ns - clock.mono_ns()));
    if (!grab.reason.empty()) trouble = grab.reason;
    if (grab.kind == Grab::Kind::end || grab.kind == Grab::Kind::lost) break;
    if (grab.kind != Grab::Kind::frame) continue;
    frame = std::move(grab.frame);
    ++taken;
  }
  if (!frame) throw CaptureError("no frame: " + trouble);
  return frame;
}

std::vector<std::byte> packed(const ImageView& image) {
  std::vector<std::byte> bytes;
  const auto row = static_cast<std::size_t>(packed_row_bytes(image.format, image.size.width));
  for (const Plane& plane : image.planes) {
    if (plane.stride == 0) {  // no plane, or JPEG, which has no rows
      bytes.insert(bytes.end(), plane.bytes.begin(), plane.bytes.end());
      continue;
    }
    const auto stride = static_cast<std::size_t>(plane.stride);
    for (std::size_t at = 0; at + row <= plane.bytes.size(); at += stride) {
      const auto line = plane.bytes.subspan(at, row);
      bytes.insert(bytes.end(), line.begin(), line.end());
    }
  }
  return bytes;
}

bool is_folder(const std::filesystem::path& path) {
  return !path.has_filename() || std::filesystem::is_directory(path);
}

}  // namespace

GrabbedFrame grab_frame(const DaemonConfig& config, const std::filesystem::path& base) {
  const Camera camera = load_camera(config.camera.file);
  const SourceSetup setup = make_source(config, camera);
  const Opened opened(*setup.source);
  const Frame frame = take_frame(*setup.source, *setup.clock);

  const ImageView& image = frame.image();
  GrabbedFrame grabbed;
  grabbed.description = setup.source->description();
  grabbed.file = (is_folder(base) ? base / "frame" : base).string() + "." +
                 (image.format == PixelFormat::mjpeg ? "jpg" : std::string(name(image.format)));
  write_file_atomically(grabbed.file, packed(image));
  return grabbed;
}

}  // namespace bole
