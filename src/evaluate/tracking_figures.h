#pragma once

#include "evaluate/detections.h"
#include "evaluate/truth.h"

namespace bole {

/// How well detections keep their ids along a drive.
struct TrackingFigures {
  /// 2 IDTP / (trees + detections), IDTP the most hits that a fixed pairing of true with found ids
  /// can have (Ristani et al., 2016). Trees and detections as tools/score.py judges them.
  double idf1 = 0;
  int id_switches = 0;  ///< times a true tree is hit by another id than before
  /// Times an id goes over to a true tree more than 1 m from the one that it hit before.
  int id_swaps = 0;
};

/// The frames of `truth`, in their order, have ids; so have the detections.
TrackingFigures measure_tracking(const Truth& truth, const Detections& tracked, double min_score);

}  // namespace bole
