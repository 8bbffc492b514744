#pragma once

#include <optional>

#include "detect/ground_tilt.h"
#include "detect/trunk_finder.h"
#include "geometry/panorama.h"

namespace bole {

/// What a trunk of that panorama says of where it stands: tangents and radians.
TrunkSight sight_of(const Trunk& trunk, const PanoramaGeometry& panorama);

/// The trunk as a witness of the tilt; nullopt when its foot is out of sight or it hardly is a
/// trunk.
std::optional<TiltWitness> witness_of(const Trunk& trunk, const PanoramaGeometry& panorama);

}  // namespace bole
