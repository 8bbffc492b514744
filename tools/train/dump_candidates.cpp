// dump_candidates OUT LOOKS FRAME...: what the networks are to learn from, by the detector's own
// code. For every frame the candidates, some of them shaken, and shapes about the true trunks;
// where LOOKS is `second` and not `first`, also what the network, as it was built in, takes for a
// trunk: what it is mistaken in, it learns most from. Of each kHead + TrunkFeatures::kCount floats:
// frame number, label (1 trunk, 0 none), shifts to the truth (see Judgement), weight, then the
// features. Where LOOKS is `close` they are those that the network, as it was built in, leaves in
// doubt, and a few others, and each is followed by the bytes of its TrunkPatches. Where it is
// `last` they are trunks only, each followed by its FootPatch::Values.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "detect/trunk_finder.h"
#include "simulate/noise.h"
#include "training_frame.h"

namespace bole::train {
namespace {

constexpr int kHead = 6;
constexpr double kMostNegatives = 200;  // a frame; the others are drawn from, and weigh more
constexpr double kNear = 1.35;          // of what a trunk's shape may be off: neither
constexpr float kSecondLooks = 0.4F;    // share of them that is kept
constexpr float kLeastDoubt = -5.5F, kMostDoubt = 4.5F;  // logit
constexpr float kDoubtful = 0.2F, kClear = 0.02F;        // shares of them that are kept

enum class Looks { first, second, close, last };

struct Label {
  float trunk = 0;  // 1, 0, or -1: neither, left out
  float centre_shift = 0, log_width = 0, foot_shift = 0;
  int which = -1;
};

// What the detector takes the panorama for: in some frames the horizon is not where it thinks, as
// on a slope or with a wrong attitude, so that it learns to trust what a trunk looks like.
PanoramaGeometry misjudged(PanoramaGeometry geometry, simulate::Random& random) {
  if (random.chance(0.4F)) geometry.top_tangent += 0.08F * random.normal();
  return geometry;
}

// The same wood in another light: another tone curve, haze, grain.
TrainingFrame in_another_light(TrainingFrame frame, int number) {
  simulate::Random random(static_cast<std::uint64_t>(number), 42);
  const float gamma = std::exp(0.35F * random.normal()), gain = random.uniform(0.6F, 1.2F);
  const float haze = random.chance(0.4F) ? random.uniform(0.1F, 0.7F) : 0;
  const float haze_level = random.uniform(60, 220), grain = random.uniform(0, 5);
  std::array<float, 256> tone;
  for (int level = 0; level < 256; ++level) {
    const float clear = 255 * gain * std::pow(static_cast<float>(level) / 255, gamma);
    tone[level] = (1 - haze) * clear + haze * haze_level;
  }
  for (std::uint8_t& pixel : frame.pixels) {
    const float value = tone[pixel] + grain * random.normal();
    pixel = static_cast<std::uint8_t>(std::clamp(value, 0.0F, 255.0F));
  }
  return frame;
}

class Dump {
 public:
  Dump(const TrainingFrame& frame, int number, int light, Looks looks, std::FILE* out)
      : frame_(frame),
        number_(number),
        looks_(looks),
        out_(out),
        random_(static_cast<std::uint64_t>(number), 43 + static_cast<std::uint32_t>(light)),
        focal_(frame.geometry.focal()),
        scale_(focal_ / kReferenceFocal),
        // Near trunks only, or far ones as well.
        search_(random_.chance(0.4F) ? Search{{1, 40}, {0.1, 1.2}} : Search{}),
        finder_({misjudged(frame.geometry, random_), frame.seen_map(), frame.height, search_}),
        found_(frame.trunks.size()) {}

  void run() {
    const auto candidates = finder_.candidates(frame_.view());
    const double kept =
        std::min(1.0, kMostNegatives / std::max(1.0, static_cast<double>(candidates.size())));
    for (const Candidate& candidate : candidates) {
      TrunkShape shape;
      EdgeFit fit;
      if (!finder_.fit(candidate, shape, fit)) continue;
      put_candidate(shape, fit, kept);
      put_second_look(shape, fit);
      std::array<float, EdgeFitter::kOtherFeet> feet;
      const int count = finder_.other_feet(shape, feet);
      for (int i = 0; i < count; ++i) {
        put_candidate(ended_at(shape, feet[i]), fit, 0.25 * kept);
        put_second_look(ended_at(shape, feet[i]), fit);
      }
    }
    for (std::size_t i = 0; i < found_.size(); ++i) put_true(frame_.trunks[i], found_[i]);
  }

 private:
  // A candidate, and now and then a shaken twin. Of those that are no trunk the share `kept`.
  void put_candidate(const TrunkShape& shape, const EdgeFit& fit, double kept) {
    const Label here = label(shape);
    const bool trunk = here.trunk > 0;
    if (trunk) found_[here.which] = shape;
    if (looks_ == Looks::last) return;
    const auto chance = static_cast<float>(trunk ? 1 : kept);
    if (random_.chance(chance)) put(shape, fit, 1 / chance);
    if (random_.chance(0.35F * chance)) {
      TrunkShape shaken = shake(shape, 0.1F, 0.15F, 0.15F);
      EdgeFit shaken_fit = fit;
      finder_.refine(shaken, shaken_fit);
      put(shaken, shaken_fit, 0.5F / chance);
    }
  }

  void put_second_look(TrunkShape shape, EdgeFit fit) {
    TrunkFeatures::Values features;
    if (looks_ == Looks::first || !finder_.glance(shape, fit, features)) return;
    Judgement judgement;
    judge_at_a_glance(std::span(&features, 1), std::span(&judgement, 1));
    if (judgement.logit < finder_.effort().worth_a_second_look || !random_.chance(kSecondLooks))
      return;
    shape = corrected(shape, judgement, focal_);
    if (!finder_.read(frame_.view(), shape, fit, features)) return;
    finder_.refine(shape, fit);
    put(shape, fit, 1 / kSecondLooks);
    if (looks_ < Looks::close || !finder_.read(frame_.view(), shape, fit, features)) return;
    put(corrected(shape, judged(features), focal_), fit, 1 / kSecondLooks);
  }

  // Shapes close about a true trunk, as the second look meets them.
  void put_true(const TrunkTruth& trunk, const std::optional<TrunkShape>& found) {
    const double width = trunk.angular_width * focal_;
    const double foot = row_of(trunk);
    if (trunk.visible < 0.5F || width < 3.5 * scale_ || trunk.range < 0.7F ||
        trunk.range > 1.2 * search_.range.high)
      return;
    const double middle = frame_.geometry.column_of_bearing(trunk.bearing) + 0.5;
    if (middle > frame_.geometry.width) return;
    TrunkShape upright;
    upright.foot = static_cast<float>(foot);
    upright.left = static_cast<float>(middle - width / 2);
    upright.right = static_cast<float>(middle + width / 2);
    if (found) {
      upright.left_slope = found->left_slope;
      upright.right_slope = found->right_slope;
      upright.dark = found->dark;
    } else {
      upright.dark = looks_dark(upright);
    }
    for (int i = 0; i < 3; ++i) {
      TrunkShape shape = shake(upright, 0.08F, 0.1F, 0.12F);
      EdgeFit fit;
      finder_.refine(shape, fit);
      if (!found && fit.agreement + fit.agreement_above < 0.3F) continue;
      put(shape, fit, 0.4F);
    }
  }

  // Of which polarity a candidate there would be.
  bool looks_dark(TrunkShape shape) const {
    float contrast[2];
    for (const bool dark : {false, true}) {
      shape.dark = dark;
      TrunkShape refined = shape;
      EdgeFit fit;
      finder_.refine(refined, fit);
      contrast[dark] = fit.contrast_left + fit.contrast_right;
    }
    return contrast[1] >= contrast[0];
  }

  TrunkShape shake(const TrunkShape& shape, float centre, float width, float foot) {
    TrunkShape shaken = shape;
    const float w = shape.width();
    const float middle = shape.centre() + centre * random_.normal() * w;
    const float half = 0.5F * w * std::exp(width * random_.normal());
    shaken.foot += foot * random_.normal() * w;
    shaken.left = middle - half;
    shaken.right = middle + half;
    return shaken;
  }

  void put(const TrunkShape& shape, const EdgeFit& fit, float weight) {
    const Label here = label(shape);
    if (here.trunk < 0 || (looks_ == Looks::last && here.trunk == 0)) return;
    TrunkFeatures::Values features;
    if (!finder_.read(frame_.view(), shape, fit, features)) return;
    // Weights stay: the close look is for the doubtful, let it dwell on them.
    if (looks_ == Looks::close && !random_.chance(in_doubt(features) ? kDoubtful : kClear)) return;
    const float head[kHead] = {static_cast<float>(number_),
                               here.trunk,
                               here.centre_shift,
                               here.log_width,
                               here.foot_shift,
                               weight};
    std::fwrite(head, sizeof(float), kHead, out_);
    std::fwrite(features.data(), sizeof(float), features.size(), out_);
    if (looks_ == Looks::close) put_bytes(finder_.patches(shape));
    if (looks_ == Looks::last) put_bytes(finder_.foot_patch(frame_.view(), shape));
  }

  template <class Patches>
  void put_bytes(const Patches& patches) {
    std::fwrite(&patches, 1, sizeof patches, out_);
  }

  static Judgement judged(const TrunkFeatures::Values& features) {
    Judgement judgement;
    judge(std::span(&features, 1), std::span(&judgement, 1));
    return judgement;
  }

  static bool in_doubt(const TrunkFeatures::Values& features) {
    const float logit = judged(features).logit;
    return logit > kLeastDoubt && logit < kMostDoubt;
  }

  // Of the foot, or of where the camera's sight of the trunk ends.
  double row_of(const TrunkTruth& trunk) const {
    const double column = frame_.geometry.column_of_bearing(trunk.bearing) + 0.5;
    return std::min<double>(frame_.geometry.row_of_tangent(trunk.foot_tangent) + 0.5,
                            finder_.last_row(static_cast<float>(column)));
  }

  // A shape is of a trunk when its middle, width and foot are near enough for the network to mend;
  // what is near but not near enough, or of a trunk hardly seen, is left out.
  Label label(const TrunkShape& shape) const {
    Label best;
    double least = 9;
    bool near_one = false;
    for (std::size_t i = 0; i < frame_.trunks.size(); ++i) {
      const TrunkTruth& trunk = frame_.trunks[i];
      const double width = trunk.angular_width * focal_;
      if (width < 2.5 * scale_ || trunk.visible < 0.05F) continue;
      const double down = row_of(trunk) - shape.foot;
      const double turn = frame_.geometry.columns;
      double across = frame_.geometry.column_of_bearing(trunk.bearing) + 0.5 - shape.centre() -
                      shape.slope() * down;
      across -= turn * std::round(across / turn);
      const double log_width = std::log(width / shape.width());
      const double x = std::abs(across) / std::max(3 * scale_, 0.3 * width);
      const double w = std::abs(log_width) / 0.42;
      const double y = std::abs(down) / std::max(6 * scale_, 0.6 * width);
      const bool tight = x < 1 && w < 1 && y < 1;
      near_one |= x < kNear && w < kNear && y < kNear && (!tight || trunk.visible < 0.25F);
      const double cost = x * x + w * w + y * y;
      if (!tight || trunk.visible < 0.25F || cost >= least) continue;
      least = cost;
      best.which = static_cast<int>(i);
      best.trunk = trunk.visible >= 0.5F && width >= 3.5 * scale_ ? 1 : -1;
      best.centre_shift = static_cast<float>(across / shape.width());
      best.log_width = static_cast<float>(log_width);
      best.foot_shift = static_cast<float>(down) / foot_unit(shape, focal_);
    }
    if (best.which < 0 && near_one) best.trunk = -1;
    return best;
  }

  const TrainingFrame& frame_;
  int number_;
  Looks looks_;
  std::FILE* out_;
  simulate::Random random_;
  double focal_, scale_;
  Search search_;
  TrunkFinder finder_;
  std::vector<std::optional<TrunkShape>> found_;  // a shape of each trunk
};

}  // namespace
}  // namespace bole::train

int main(int count, char** arguments) {
  using bole::train::Looks;
  const std::map<std::string_view, Looks> all{{"first", Looks::first},
                                              {"second", Looks::second},
                                              {"close", Looks::close},
                                              {"last", Looks::last}};
  const auto looks = count < 4 ? all.end() : all.find(arguments[2]);
  if (looks == all.end()) {
    std::fputs("usage: dump_candidates OUT first|second|close|last FRAME...\n", stderr);
    return 2;
  }
  std::FILE* out = std::fopen(arguments[1], "wb");
  if (!out) return 1;
  for (int i = 3; i < count; ++i) {
    const std::filesystem::path file = arguments[i];
    const auto frame = bole::train::TrainingFrame::load(file);
    const int number = std::stoi(file.stem().string());
    bole::train::Dump(frame, number, 0, looks->second, out).run();
    const auto lit = bole::train::in_another_light(frame, number);
    bole::train::Dump(lit, number, 1, looks->second, out).run();
  }
  return std::fclose(out) == 0 ? 0 : 1;
}
