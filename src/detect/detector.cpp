#include "detect/detector.h"

#include "detect/paper.h"

namespace bole {

std::optional<DetectorMode> detector_mode_from_name(std::string_view name) {
  if (name == "paper") return DetectorMode::paper;
  if (name == "bole") return DetectorMode::bole;
  return std::nullopt;
}

std::unique_ptr<Detector> make_detector(DetectorMode, const DetectorSetup& setup) {
  return std::make_unique<PaperDetector>(setup);
}

}  // namespace bole
