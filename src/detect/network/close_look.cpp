#include "detect/network/close_look.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "detect/network/network_weights.h"

namespace bole {
namespace {

#include "detect/network/close_look_weights.inc"

namespace w = close_look_weights;

constexpr int kSide = TrunkPatches::kSide;
constexpr int kConvolutions = 4;  // of 3 x 3 cells, at every other cell
constexpr int kChannels[kConvolutions + 1] = {1, 16, 32, 48, 64};
constexpr int kLastSide = kSide >> kConvolutions;
constexpr int kLast = kLastSide * kLastSide * kChannels[kConvolutions];
constexpr int kSummary = 48;

constexpr int kFeatures = TrunkFeatures::kCount;
constexpr int kPairs = (w::kInputs + 1) / 2;
static_assert(w::kInputs == kFeatures + 2 * kSummary && w::kLimit <= kMostInput,
              "train the networks anew");

struct Layer {
  const std::int16_t* weights;
  const float* bias;
};
struct PatchLayers {
  Layer convolutions[kConvolutions];
  Layer summary;
};

// Of a picture's runs of three values; a fourth one, of no weight, makes pairs of them.
template <std::size_t kUnits>
constexpr auto in_even_runs(const float (&weights)[9][kUnits]) {
  struct {
    float at[12][kUnits];
  } even{};
  for (std::size_t i = 0; i < 9; ++i)
    for (std::size_t j = 0; j < kUnits; ++j) even.at[i / 3 * 4 + i % 3][j] = weights[i][j];
  return even;
}

template <class Weights>
struct InWholeUnits {
  template <class Array>
  static constexpr bool fits(const Array&, std::size_t inputs, int units) {
    return std::extent_v<Array, 0> == inputs &&
           std::extent_v<Array, 1> == static_cast<std::size_t>(units);
  }
  static_assert(fits(Weights::kToFirst, 9 * kChannels[0], kChannels[1]) &&
                    fits(Weights::kToSecond, 9 * kChannels[1], kChannels[2]) &&
                    fits(Weights::kToThird, 9 * kChannels[2], kChannels[3]) &&
                    fits(Weights::kToFourth, 9 * kChannels[3], kChannels[4]) &&
                    fits(Weights::kToSummary, kLast, kSummary),
                "train the networks anew");

  alignas(64) static constexpr auto kFirstUnits = whole_units(in_even_runs(Weights::kToFirst).at);
  alignas(64) static constexpr auto kSecondUnits = whole_units(Weights::kToSecond);
  alignas(64) static constexpr auto kThirdUnits = whole_units(Weights::kToThird);
  alignas(64) static constexpr auto kFourthUnits = whole_units(Weights::kToFourth);
  alignas(64) static constexpr auto kSummaryUnits = whole_units(Weights::kToSummary);
  static constexpr PatchLayers kLayers{{{kFirstUnits.data(), Weights::kFirstBias.data()},
                                        {kSecondUnits.data(), Weights::kSecondBias.data()},
                                        {kThirdUnits.data(), Weights::kThirdBias.data()},
                                        {kFourthUnits.data(), Weights::kFourthBias.data()}},
                                       {kSummaryUnits.data(), Weights::kSummaryBias.data()}};
};

alignas(64) constexpr auto kToFirst = whole_units(w::kToFirst);
alignas(64) constexpr auto kToOutput = padded(w::kToOutput);

// The most that any layer needs of what `size(side, channels)` is for it.
template <class Size>
constexpr int most_of_layers(const Size& size) {
  int most = 0;
  for (int i = 0; i < kConvolutions; ++i) most = std::max(most, size(kSide >> i, i));
  return most;
}

// A row and a column of zeros before them, and the one value more that the last run of an odd
// number is read with.
constexpr int size_of_cells(int side, int channels) {
  return (side + 1) * (side + 1) * channels + 1;
}

// Cells in whole units.
class Cells {
 public:
  void clear(int side, int channels) {
    side_ = side;
    channels_ = channels;
    std::fill_n(at_.begin(), size_of_cells(side, channels), std::int16_t{0});
  }
  std::int16_t* row(int y) { return at_.data() + ((y + 1) * (side_ + 1) + 1) * channels_; }
  // The 3 x 3 cells about every other one.
  Windows windows() const {
    const std::ptrdiff_t row = (side_ + 1) * channels_;
    return {.first = at_.data(),
            .rows = side_ / 2,
            .across = side_ / 2,
            .step = 2 * channels_,
            .row_step = 2 * row,
            .runs = 3,
            .run_pairs = (3 * channels_ + 1) / 2,
            .run_step = row};
  }

 private:
  static constexpr int kMost =
      most_of_layers([](int side, int i) { return size_of_cells(side, kChannels[i]); });

  alignas(64) std::array<std::int16_t, kMost> at_;
  int side_ = 0, channels_ = 0;
};

void summarise(const TrunkPatches::Patch& patch, const PatchLayers& layers, float* summary) {
  constexpr int kMostUnits =
      most_of_layers([](int side, int i) { return side / 2 * (side / 2) * kChannels[i + 1]; });
  constexpr int kFromPatch = kInputUnits / TrunkPatches::kUnits;
  Cells cells;
  alignas(64) std::array<float, kMostUnits> units;
  int side = kSide;
  cells.clear(side, kChannels[0]);
  for (int y = 0; y < side; ++y) {
    std::transform(patch.begin() + y * side, patch.begin() + (y + 1) * side, cells.row(y),
                   [](int value) { return static_cast<std::int16_t>(value * kFromPatch); });
  }
  for (int i = 0; i < kConvolutions; ++i) {
    const int channels = kChannels[i];
    if (i > 0) {
      cells.clear(side, channels);
      for (int y = 0; y < side; ++y)
        quantise(units.data() + y * side * channels, side * channels, cells.row(y));
    }
    const Layer& layer = layers.convolutions[i];
    convolve(cells.windows(), layer.weights, layer.bias, kChannels[i + 1], units.data());
    side /= 2;
  }
  alignas(64) std::array<std::int16_t, kLast> last;
  quantise(units.data(), kLast, last.data());
  hidden_layer(last.data(), 1, kLast / 2, layers.summary.weights, layers.summary.bias, kSummary,
               summary);
}

}  // namespace

Judgement judge_closely(const TrunkFeatures::Values& features, const TrunkPatches& patches) {
  std::array<float, 2 * kSummary> summaries;
  summarise(patches.trunk, InWholeUnits<w::Trunk>::kLayers, summaries.data());
  summarise(patches.around, InWholeUnits<w::Around>::kLayers, summaries.data() + kSummary);
  alignas(64) std::array<std::int16_t, std::size_t{2} * kPairs> inputs;
  inputs.back() = 0;
  standardise(features.data(), kFeatures, w::kMean, w::kScale, w::kLimit, inputs.data());
  quantise(summaries.data(), 2 * kSummary, inputs.data() + kFeatures);
  std::array<float, w::kFirst> first;
  hidden_layer(inputs.data(), 1, kPairs, kToFirst.data(), w::kFirstBias.data(), w::kFirst,
               first.data());
  return judgement_of(first, w::kToSecond, w::kSecondBias, kToOutput, w::kOutputBias);
}

}  // namespace bole
