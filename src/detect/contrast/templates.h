#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "detect/contrast/bands.h"
#include "detect/detector.h"
#include "detect/range_posterior.h"

namespace bole {

/// A place where a trunk may stand, as coarse as the templates are.
struct Candidate {
  float left = 0;    ///< column of the left edge
  float width = 0;   ///< columns
  float foot = 0;    ///< row just below the visible trunk
  bool dark = true;  ///< darker than what is beside it
  float rank = 0;    ///< contrast, more where it ends as that of a searched tree does
};

/// Contrast templates: a trunk is a pair of opposite edges that run down the image together, and it
/// ends where they do.
///
/// For widths in geometric steps the two edges' contrasts are clipped, joined so that the weaker
/// one counts most, and summed down the column; the sum starts anew wherever it falls below zero,
/// and its highest value marks the foot. Below the horizon a trunk is darker (or brighter) than
/// both sides; above it may be darker than the sky on one side and brighter than foliage on the
/// other, so there the sign counts for less.
class Templates {
 public:
  /// The margin that Bands needs for these templates and whatever reads around a candidate.
  static int margin(const DetectorSetup& setup);

  /// Of `bands` only what is seen and the margin are asked for.
  Templates(const DetectorSetup& setup, const Bands& bands, int most_candidates);

  /// The places of highest rank, best first; valid until the next call.
  std::span<const Candidate> find(const Bands& bands);

 private:
  struct Size {
    int width = 0;                      // columns
    int flank = 0;                      // index into flanks_
    int first_foot = 0, last_foot = 0;  // bands: the foot is the lower border of one of them
    std::vector<double> rank_factors;   // of evidence, by the band that it ends in
  };
  struct Unseen {  // evaluated columns [first, last) of a band where a mean meets the mask
    int band = 0, first = 0, last = 0;
  };
  struct Flank {
    int width = 0;  // columns of the means on either side of an edge
    int step = 0;   // every how many columns it is evaluated
    int pitch = 0;  // evaluated columns a band
    int count = 0;  // of them asked for
    std::vector<Unseen> unseen;
  };
  struct Peaks {  // best sum over all feet, for every left edge; evidence begins `pad_` before them
    std::vector<std::int16_t> evidence;
    std::vector<std::int16_t> foot;
  };

  struct Neighbour {  // evidence at column x of left edges: 2 x + offset, shifted right
    const std::int16_t* evidence = nullptr;
    int offset = 0, shift = 0;
    bool beats(int left, int evidence_there) const;
  };

  void weigh_feet(const DetectorSetup& setup, const RangePosterior& posterior, Size& size) const;
  void add_flank(const Bands& bands, int width);
  int thinned_pitch(int step) const;
  void thin(const Bands& bands, int step);
  const std::uint16_t* sums_of(const Bands& bands, int band, int step) const;
  void respond(const Bands& bands, const Flank& flank);
  void accumulate(int size_index);
  void pad(std::int16_t* evidence, int count) const;
  void collect(int size_index, int polarity);
  Neighbour neighbour(int size_index, int polarity, const Size& size) const;
  int part_of(float column) const;
  bool has_twin(const Candidate& candidate) const;
  void thin_out();

  int columns_, width_, bands_, horizon_band_, widest_, pad_;
  std::size_t most_;
  bool wraps_;
  double focal_;
  std::vector<Size> sizes_;
  std::vector<Flank> flanks_;
  // Of one step at a time: bands x pitch.
  std::vector<std::uint16_t> thinned_;
  // Of one flank at a time, so that they stay in the cache: bands x pitch, and above the horizon
  // what either sign makes of it.
  std::vector<std::uint8_t> responses_, rising_, falling_;
  std::vector<Peaks> peaks_[2];  // dark, bright
  std::vector<int> places_;
  std::vector<Candidate> found_, kept_;
  // Kept candidates by the part of the turn that their centre lies in: a list for each.
  static constexpr int kParts = 64;
  std::array<int, kParts> latest_in_part_;
  std::vector<int> earlier_in_part_;
};

}  // namespace bole
