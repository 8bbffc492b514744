#pragma once

#include <span>
#include <vector>

#include "detect/contrast/templates.h"
#include "detect/contrast/trunk_shape.h"
#include "detect/network/network.h"
#include "detect/network/trunk_features.h"
#include "detect/network/trunk_patches.h"

namespace bole {

/// A trunk as it stands in the panorama, before geometry makes metres of it.
struct Trunk {
  TrunkShape shape;
  EdgeFit fit;
  float logit = 0;            ///< of the probability that this is a trunk
  float centre_sigma = 0;     ///< columns
  float width_sigma = 0;      ///< of the logarithm
  float foot_sigma = 0;       ///< rows
  bool expected = false;      ///< earlier frames lead to expect a trunk of this outline
  bool cut = false;           ///< it goes on below what the camera sees: its foot is out of sight
  bool seen_closely = false;  ///< by the network that is shown pixels
};

/// How much is looked at in a frame.
struct Effort {
  int candidates = 0;          ///< at most
  int close_looks = 0;         ///< at most
  int last_looks = 0;          ///< at most
  float worth_other_feet = 0;  ///< logit of a first look: with a wrong foot a trunk looks like none
  float worth_a_second_look = 0;  ///< logit of a first look
  float doubt = 0;                ///< logits up to this, of either sign, are worth a close look

  /// The farther the search goes, the more trunks there are, and the harder they are to tell.
  static Effort for_reach(double range);  ///< the farthest that is searched, metres
};

/// Candidates, their refinement and judgement.
class TrunkFinder {
 public:
  explicit TrunkFinder(const DetectorSetup& setup);

  /// Trunks that are not out of the question, the better ones first, as to probability and width
  /// before the close and the last looks; valid until the next call. `expected`: outlines to try
  /// where no trunk like them is found for sure, whatever the templates say; they go before others
  /// of the same pixels.
  std::span<Trunk> find(const PanoramaView& panorama, std::span<const Candidate> expected = {});

  /// The steps of find, for the training of the network.
  std::span<const Candidate> candidates(const PanoramaView& panorama);
  bool fit(const Candidate& candidate, TrunkShape& shape, EdgeFit& fit) const {
    return fitter_.fit(bands_, candidate, shape, fit);
  }
  int other_feet(const TrunkShape& shape, std::array<float, EdgeFitter::kOtherFeet>& feet) const {
    return fitter_.other_feet(bands_, shape, feet);
  }
  const Effort& effort() const { return effort_; }
  float last_row(float column) const { return fitter_.last_row(column); }
  void refine(TrunkShape& shape, EdgeFit& fit) const { fitter_.refine(bands_, shape, fit); }
  /// False, and nothing read, when the outline leads farther out of the panorama than Bands
  /// goes.
  [[nodiscard]] bool read(const PanoramaView& panorama, const TrunkShape& shape, const EdgeFit& fit,
                          TrunkFeatures::Values& out) const;
  /// The same of what judge_at_a_glance is shown.
  [[nodiscard]] bool glance(const TrunkShape& shape, const EdgeFit& fit,
                            TrunkFeatures::Values& out) const;
  FootPatch::Values foot_patch(const PanoramaView& panorama, const TrunkShape& shape) const {
    return reader_.foot_patch(bands_, panorama, shape);
  }
  /// Of the latest panorama that was searched.
  TrunkPatches patches(const TrunkShape& shape) const;

 private:
  bool readable(const TrunkShape& shape) const;
  // A trunk as it is first met.
  struct Sight {
    Trunk trunk;
    Judgement judgement;
  };
  template <class Read, class Judge>
  static void judge_all(std::span<Sight> sights, const Read& read, const Judge& judge);
  void glance(std::span<Sight> sights) const;
  void look(const PanoramaView& panorama, std::span<Sight> sights) const;
  static void keep_best(std::vector<Sight>& sights, float least);
  void look_again(const PanoramaView& panorama, std::span<const Sight> sights);
  void take(const Sight& sight);
  void settle(Trunk& trunk, const Judgement& judgement) const;
  void look_at_other_feet(const PanoramaView& panorama);
  void look_where_expected(const PanoramaView& panorama, std::span<const Candidate> expected);
  bool explained(const TrunkShape& shape, float logit) const;
  bool has_outline(const TrunkShape& shape, const Candidate& outline) const;
  float whole_turns(float columns) const;
  void suppress(const PanoramaView& panorama);
  bool in_doubt(const Trunk& trunk) const;
  void look_closely(const PanoramaView& panorama, Trunk& trunk) const;
  void look_last(const PanoramaView& panorama);
  bool same_pixels(const TrunkShape& a, const TrunkShape& b) const;

  int columns_;
  bool wraps_;
  double focal_;
  float narrowest_, highest_foot_;  // of trunks that are searched for: columns, row
  float highest_located_;           // the row of the highest foot that is worth a last look
  Effort effort_;
  Bands bands_;
  Templates templates_;
  EdgeFitter fitter_;
  FeatureReader reader_;
  std::vector<Sight> sights_, others_;  // first looks
  std::vector<Trunk> trunks_, kept_;
};

}  // namespace bole
