#include "detect/paper/paper_candidates.h"

#include <algorithm>
#include <cstdlib>
#include <tuple>

namespace bole {
namespace {

// Minima below the threshold are rare: whole blocks of columns are ruled out at once.
constexpr int kBlock = 32;

bool any_below(const float* scores, float threshold) {
  unsigned below = 0;
  for (int j = 0; j < kBlock; ++j) below |= scores[j] < threshold ? 1U : 0U;
  return below != 0;
}

// Keeps, best first, those that no better kept candidate rivals.
template <class Rivals>
void keep_best(std::vector<PaperCandidate>& candidates, const Rivals& rivals) {
  auto kept_end = candidates.begin();
  for (const PaperCandidate& candidate : candidates) {
    const auto beats = [&](const PaperCandidate& better) { return rivals(better, candidate); };
    if (std::none_of(candidates.begin(), kept_end, beats)) *kept_end++ = candidate;
  }
  candidates.erase(kept_end, candidates.end());
}

// Whether the scores rise after column j, and after those that equal it.
bool rises_after(std::span<const float> scores, int j, bool wraps) {
  const int width = static_cast<int>(scores.size());
  for (int i = 1; i < width; ++i) {
    const int next = j + i;
    if (next >= width && !wraps) return true;
    const float score = scores[next % width];
    if (score != scores[j]) return score > scores[j];
  }
  return true;
}

}  // namespace

void append_minima(std::span<const float> scores, float threshold, bool wraps, int index,
                   std::vector<PaperCandidate>& candidates) {
  const int width = static_cast<int>(scores.size());
  for (int block = 0; block < width; block += kBlock) {
    const int end = std::min(block + kBlock, width);
    if (end - block == kBlock && !any_below(&scores[block], threshold)) continue;
    for (int j = block; j < end; ++j) {
      if (!(scores[j] < threshold)) continue;
      const int left = j > 0 ? j - 1 : wraps ? width - 1 : 0;
      const bool below_left = scores[j] < scores[left] || left == j;
      if (below_left && rises_after(scores, j, wraps)) candidates.push_back({j, index, scores[j]});
    }
  }
}

void suppress(const std::vector<PaperTemplate>& templates, int width,
              std::vector<PaperCandidate>& candidates) {
  std::sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) {
    return std::tie(a.score, a.index, a.column) < std::tie(b.score, b.index, b.column);
  });
  const auto overlap = [&](const PaperCandidate& a, const PaperCandidate& b) {
    const int apart = std::abs(a.column - b.column);
    const double wider = std::max(templates[a.index].width_px, templates[b.index].width_px);
    return 2 * (width > 0 ? std::min(apart, width - apart) : apart) < wider;
  };
  keep_best(candidates, [&](const PaperCandidate& a, const PaperCandidate& b) {
    return templates[a.index].foot_row == templates[b.index].foot_row && overlap(a, b);
  });
  keep_best(candidates, overlap);
}

}  // namespace bole
