#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "geometry/panorama_view.h"
#include "warp/camera_files.h"

namespace bole {

class WarpTable;  // owner of warp/ designs the entries (compact, ready for SIMD)

/// Builds the table: for every pixel of the kept panorama, where in the raw image it lies.
WarpTable build_warp_table(const Camera& camera);

}  // namespace bole
