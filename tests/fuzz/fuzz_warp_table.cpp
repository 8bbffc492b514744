#include <cstring>
#include <vector>

#include "base/checksum.h"
#include "base/errors.h"
#include "fuzz/fuzz_target.h"
#include "geometry/pinhole.h"
#include "warp/warp_table_file.h"
#include "warp/warper.h"

namespace bole {
namespace {

const std::vector<std::byte>& good_table() {
  static const std::vector<std::byte> bytes = [] {
    Camera camera;
    camera.config.mount.height = 1;
    camera.config.columns = 64;
    camera.config.range_min = 1;
    camera.model = std::make_unique<PinholeModel>(pinhole_from_field_of_view(1.5, {40, 32}));
    camera.robot_from_camera = robot_from_forward_camera(camera.config.mount);
    const WarpTable table = build_warp_table(camera);
    return std::vector<std::byte>(table.bytes().begin(), table.bytes().end());
  }();
  return bytes;
}

// Changed bytes with a checksum that fits, as a wrong program might have written them.
void mend_checksum(std::vector<std::byte>& bytes) {
  constexpr std::size_t kCrc = offsetof(WarpTableHead, crc);
  const std::uint32_t crc = crc32(std::span(bytes).subspan(offsetof(WarpTableHead, bytes)));
  std::memcpy(bytes.data() + kCrc, &crc, sizeof crc);
}

}  // namespace
}  // namespace bole

// The input is a list of changes to a good table, three bytes each: where (two bytes), and what.
// Whatever table is accepted must keep the warp inside the frame.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace bole;
  std::vector<std::byte> bytes = good_table();
  for (; size >= 3; data += 3, size -= 3) {
    const std::size_t at = (data[0] | static_cast<std::size_t>(data[1]) << 8) % bytes.size();
    bytes[at] = std::byte{data[2]};
  }
  mend_checksum(bytes);
  try {
    const WarpTable table = WarpTable::parse(std::move(bytes), "fuzz", 0);
    if (table.image_size().width > 256 || table.image_size().height > 256) return 0;
    const std::vector<std::byte> frame(packed_frame_bytes(PixelFormat::grey, table.image_size()));
    Warper(table).warp(*view_packed(PixelFormat::grey, table.image_size(), frame));
  } catch (const ConfigError&) {
    return 0;
  }
  return 0;
}
