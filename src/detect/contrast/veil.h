#pragma once

#include "geometry/panorama_view.h"

namespace bole {

/// Quarters of a grey level; no veil is thicker.
inline constexpr int kThickestVeil = 4 * 255;

/// The brightness that fog, a dusty dome or stray light in the lens adds to every pixel alike, in
/// quarters of a grey level; 0 where something is as dark as a clear picture of a wood shows. In
/// the logarithm of what lies above it contrasts are again what they were.
///
/// After the subtraction of dark objects in remote sensing: something in a picture is always nearly
/// black, so what the darkest pixels show is the veil (Chavez, Remote Sensing of Environment 24,
/// 1988). They are looked for in every eighth row and column of what is seen.
int veil_over(const PanoramaView& panorama, const SeenMap& seen);

}  // namespace bole
