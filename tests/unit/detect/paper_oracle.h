#pragma once

#include <opencv2/core.hpp>

#include "detect/paper/paper_templates.h"

namespace bole {

/// S of one template at each column, literally: the whole panorama filtered in two dimensions by
/// OpenCV, then summed down the columns in double precision. `wraps`: the panorama continues round
/// the full turn; else as its outermost columns.
cv::Mat1d literal_paper_scores(const cv::Mat1b& panorama, bool wraps, const PaperTemplate& t);

}  // namespace bole
