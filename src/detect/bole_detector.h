#pragma once

#include <memory>

#include "detect/detector.h"

namespace bole {

/// The product's detector: contrast templates find candidates, lines are fitted to their edges, a
/// small network judges and corrects each, and of those that claim the same pixels the most
/// probable explains the others away.
std::unique_ptr<Detector> make_bole_detector(const DetectorSetup& setup);

}  // namespace bole
