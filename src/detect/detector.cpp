#include "detect/detector.h"

#include "detect/bole_detector.h"
#include "detect/paper/paper.h"

namespace bole {

std::optional<DetectorMode> detector_mode_from_name(std::string_view name) {
  if (name == "paper") return DetectorMode::paper;
  if (name == "bole") return DetectorMode::bole;
  return std::nullopt;
}

std::unique_ptr<Detector> make_detector(DetectorMode mode, const DetectorSetup& setup) {
  if (mode == DetectorMode::bole) return make_bole_detector(setup);
  return std::make_unique<PaperDetector>(setup);
}

}  // namespace bole
