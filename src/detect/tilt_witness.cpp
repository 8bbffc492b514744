#include "detect/tilt_witness.h"

#include <algorithm>
#include <cmath>

#include "detect/log_odds.h"

namespace bole {
namespace {

constexpr float kWitness = 0.3F;  // probability of a trunk that tells of the ground's tilt

}  // namespace

TrunkSight sight_of(const Trunk& trunk, const PanoramaGeometry& panorama) {
  const double focal = panorama.focal();
  return {.down = -panorama.tangent_of_row(trunk.shape.foot - 0.5),
          .down_sigma = trunk.foot_sigma / focal,
          .angular_width = std::clamp(trunk.shape.width() / focal, 1e-3, 2.5),
          .cut = trunk.cut};
}

std::optional<TiltWitness> witness_of(const Trunk& trunk, const PanoramaGeometry& panorama) {
  if (trunk.cut || probability(trunk.logit) < kWitness) return std::nullopt;
  return TiltWitness{.bearing = panorama.bearing_of_column(trunk.shape.centre() - 0.5),
                     .sight = sight_of(trunk, panorama),
                     .lean = trunk.shape.slope(),
                     .weight = probability(trunk.logit)};
}

}  // namespace bole
