#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "detect/expected_trunk.h"
#include "detect/tree.h"
#include "geometry/camera_config.h"
#include "geometry/panorama_view.h"

namespace bole {

/// What stays the same from frame to frame.
struct DetectorSetup {
  PanoramaGeometry panorama;
  SeenMap seen;         ///< of the panorama's size; must outlive the detector
  double height = 1.0;  ///< metres, viewpoint above the ground
  Search search;
};

/// See make_detector.
enum class DetectorMode { paper, bole };
/// By the name that boled.toml gives it; nullopt for any other.
std::optional<DetectorMode> detector_mode_from_name(std::string_view name);

/// Finds trunks in one panorama after the other. Not for use by two threads at once.
class Detector {
 public:
  virtual ~Detector() = default;

  /// The trunks of one panorama of the setup's geometry, best score first; valid until the next
  /// call. Allocates nothing once it has seen a few frames. Where trunks are `expected` it looks
  /// once more, if it can; what it answers is what this panorama shows.
  std::span<const Tree> detect(const PanoramaView& panorama,
                               std::span<const ExpectedTrunk> expected = {}) {
    return find(panorama, expected);
  }

 private:
  virtual std::span<const Tree> find(const PanoramaView& panorama,
                                     std::span<const ExpectedTrunk> expected) = 0;
};

/// `paper`: Lu and Rasmussen's contrast templates, as a reference. `bole`: the product.
std::unique_ptr<Detector> make_detector(DetectorMode mode, const DetectorSetup& setup);

}  // namespace bole
