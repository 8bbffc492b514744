#include "detect/close_look.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "detect/network_weights.h"

namespace bole {
namespace {

#include "detect/close_look_weights.inc"

namespace w = close_look_weights;

constexpr int kSide = TrunkPatches::kSide;
constexpr int kConvolutions = 4;  // of 3 x 3 cells, at every other cell
constexpr int kChannels[kConvolutions + 1] = {1, 16, 16, 32, 48};
constexpr int kLastCells = 4;
constexpr int kSummary = 48;

constexpr int kFeatures = TrunkFeatures::kCount;
constexpr int kInputs = (kFeatures + 2 * kSummary + 1) / 2 * 2;
static_assert(w::kInputs == kFeatures + 2 * kSummary, "train the networks anew");

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
  alignas(64) static constexpr auto kFirst = whole_units(in_even_runs(Weights::kToFirst).at);
  alignas(64) static constexpr auto kSecond = whole_units(Weights::kToSecond);
  alignas(64) static constexpr auto kThird = whole_units(Weights::kToThird);
  alignas(64) static constexpr auto kFourth = whole_units(Weights::kToFourth);
  alignas(64) static constexpr auto kSummary = whole_units(Weights::kToSummary);
  static constexpr PatchLayers kLayers{{{kFirst.data(), Weights::kFirstBias.data()},
                                        {kSecond.data(), Weights::kSecondBias.data()},
                                        {kThird.data(), Weights::kThirdBias.data()},
                                        {kFourth.data(), Weights::kFourthBias.data()}},
                                       {kSummary.data(), Weights::kSummaryBias.data()}};
};

alignas(64) constexpr auto kToFirst = whole_units(w::kToFirst);
alignas(64) constexpr auto kToOutput = padded(w::kToOutput);

// Cells in whole units, with a row and a column of zeros before them.
struct Cells {
  alignas(64) std::array<std::int16_t, 17 * 17 * 16 + 1> at;
  int side = 0, channels = 0;

  void clear(int new_side, int new_channels) {
    side = new_side;
    channels = new_channels;
    std::fill_n(at.begin(), (side + 1) * (side + 1) * channels + 1, std::int16_t{0});
  }
  std::int16_t* row(int y) { return at.data() + ((y + 1) * (side + 1) + 1) * channels; }
  // The 3 x 3 cells about every other one.
  Windows windows() const {
    const std::ptrdiff_t row = (side + 1) * channels;
    return {.first = at.data(),
            .rows = side / 2,
            .across = side / 2,
            .step = 2 * channels,
            .row_step = 2 * row,
            .runs = 3,
            .run_pairs = (3 * channels + 1) / 2,
            .run_step = row};
  }
};

void summarise(const TrunkPatches::Patch& patch, const PatchLayers& layers, float* summary) {
  Cells cells;
  cells.clear(kSide, 1);
  constexpr int kFromPatch = kInputUnits / TrunkPatches::kUnits;
  for (int y = 0; y < kSide; ++y) {
    std::transform(patch.begin() + y * kSide, patch.begin() + (y + 1) * kSide, cells.row(y),
                   [](int value) { return static_cast<std::int16_t>(value * kFromPatch); });
  }
  alignas(64) std::array<float, 16 * 16 * 16> units;
  for (int i = 0; i < kConvolutions; ++i) {
    const int side = cells.side / 2, channels = kChannels[i + 1];
    const Layer& layer = layers.convolutions[i];
    convolve(cells.windows(), layer.weights, layer.bias, channels, units.data());
    cells.clear(side, channels);
    for (int y = 0; y < side; ++y)
      quantise(units.data() + y * side * channels, side * channels, cells.row(y));
  }
  constexpr int kLast = kLastCells * kChannels[kConvolutions];
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
  alignas(64) std::array<std::int16_t, kInputs> inputs;
  standardise(features.data(), kFeatures, w::kMean, w::kScale, w::kLimit, inputs.data());
  quantise(summaries.data(), 2 * kSummary, inputs.data() + kFeatures);
  if (kInputs > w::kInputs) inputs.back() = 0;
  std::array<float, w::kFirst> first;
  hidden_layer(inputs.data(), 1, kInputs / 2, kToFirst.data(), w::kFirstBias.data(), w::kFirst,
               first.data());
  return judgement_of(first, w::kToSecond, w::kSecondBias, kToOutput, w::kOutputBias);
}

}  // namespace bole
