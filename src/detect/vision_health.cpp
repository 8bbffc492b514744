#include "detect/vision_health.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <numeric>

namespace bole {
namespace {

constexpr int kRowStep = 6, kColumnStep = 4;
// Where sharpness is read.
constexpr int kSharpFrom = 2, kSharpStep = 2 * kRowStep;  // rows
constexpr int kFarPlaces = 4, kFar = kFarPlaces * kColumnStep;
constexpr int kNoise = 8;  // in a sum of four pixels
constexpr int kFramesToBelieve = 3;
constexpr int kRepeatsOfFrozen = 3;

constexpr int kSaturated = 250;
constexpr float kDarkHigh = 14;        // grey levels
constexpr float kGlareGround = 0.35F;  // shares
constexpr float kGlareAll = 0.6F;
constexpr float kVeiledMedian = 200;  // grey levels
constexpr float kVeiledContrast = 24;
constexpr float kEvenSpread = 0.12F;  // of the sector's grey
constexpr float kEvenLevels = 6;      // grey levels
constexpr float kCoveredShare = 0.25F;
constexpr float kSharpness = 0.15F;  // fine over coarse structure
constexpr float kSmearedShare = 0.25F;

using Histogram = std::array<std::uint32_t, 256>;

float share(std::uint32_t part, std::uint32_t of) {
  return of > 0 ? static_cast<float>(part) / static_cast<float>(of) : 0;
}

// Of a row's whole words, going on from the rows before: in four parts, since each step waits for
// the one before.
using Checksum = std::array<std::uint64_t, 4>;
void add_row(const std::uint8_t* pixels, int width, Checksum& checksum) {
  const auto add = [](std::uint64_t& part, const std::uint8_t* from) {
    std::uint64_t word;
    std::memcpy(&word, from, sizeof word);
    part = (part ^ word) * 0x9e3779b97f4a7c15ULL;
    part ^= part >> 32;
  };
  int x = 0;
  for (; x + 32 <= width; x += 32)
    for (int k = 0; k < 4; ++k) add(checksum[k], pixels + x + 8 * k);
  for (; x + 8 <= width; x += 8) add(checksum[0], pixels + x);
}

// The grey level below which `part` of the pixels lie.
int quantile(const Histogram& histogram, double part) {
  const auto total = std::accumulate(histogram.begin(), histogram.end(), std::uint32_t{0});
  const auto wanted = static_cast<std::uint32_t>(part * total);
  std::uint32_t below = 0;
  for (int level = 0; level < 256; ++level) {
    below += histogram[level];
    if (below > wanted) return level;
  }
  return 255;
}

}  // namespace

std::string_view name(VisionHealth::Reason reason) {
  using Reason = VisionHealth::Reason;
  switch (reason) {
    case Reason::none:
      return "";
    case Reason::dark:
      return "dark";
    case Reason::glare:
      return "glare";
    case Reason::covered:
      return "covered";
    case Reason::smeared:
      return "smeared";
    case Reason::frozen:
      break;
  }
  return "frozen";
}

VisionHealth::VisionHealth(const PanoramaGeometry& geometry, const SeenMap& seen)
    : geometry_(geometry) {
  for (int i = 0; i < kSectors; ++i) {
    Sector& sector = sectors_[i];
    sector.first = geometry.width * i / kSectors;
    sector.last = geometry.width * (i + 1) / kSectors;
    int seen_columns = 0;
    for (int x = sector.first; x < sector.last; ++x)
      seen_columns += seen.columns[x].last - seen.columns[x].first > geometry.rows / 4;
    sector.seen = 2 * seen_columns > sector.last - sector.first;
    find_places(seen, sector);
    even_.resize(std::max<std::size_t>(even_.size(), sector.places + kFarPlaces));
  }
  odd_.resize(even_.size());
  find_runs(seen);
}

void VisionHealth::find_runs(const SeenMap& seen) {
  const int horizon = static_cast<int>(std::ceil(geometry_.horizon_row()));
  for (int row = 0; row < geometry_.rows; row += kRowStep) {
    const std::uint8_t* ok = seen.pixels.data() + static_cast<std::size_t>(row) * geometry_.width;
    std::vector<Run>& runs = row < horizon ? above_ : ground_;
    for (int i = 0; i < kSectors; ++i) {
      for (int x = sectors_[i].first; x < sectors_[i].last; x += kColumnStep) {
        if (!ok[x]) continue;
        const Run last = runs.empty() ? Run{} : runs.back();
        if (last.row != row || last.sector != i || last.last != x) runs.push_back({row, i, x, x});
        runs.back().last = x + kColumnStep;
        ground_pixels_ += row >= horizon;
      }
    }
  }
}

void VisionHealth::find_places(const SeenMap& seen, Sector& sector) const {
  const int columns = sector.last - sector.first;
  sector.places = std::max(0, (columns - kFar - 2 + kColumnStep) / kColumnStep);
  for (int row = kSharpFrom; row + 2 < geometry_.rows; row += kSharpStep) {
    const std::uint8_t* ok = seen.pixels.data() + static_cast<std::size_t>(row) * geometry_.width;
    for (int k = 0; k < sector.places; ++k) {
      const int x = sector.first + k * kColumnStep;
      sector.comparable.push_back(ok[x] && ok[x + kFar] ? 1 : 0);
    }
  }
}

// Fine over coarse structure along the rows: how much the brightness bends from one pair of columns
// to the next, against how much it differs between pairs that lie far apart. What noise alone makes
// counts in neither.
float VisionHealth::sharpness(const PanoramaView& panorama, const Sector& sector) {
  const std::uint8_t* comparable = sector.comparable.data();
  std::int16_t* const even = even_.data();
  std::int16_t* const odd = odd_.data();
  std::int64_t fine = 0, coarse = 0;
  for (int row = kSharpFrom; row + 2 < geometry_.rows; row += kSharpStep) {
    const std::uint8_t* above = panorama.row(row) + sector.first;
    const std::uint8_t* below = panorama.row(row + 1) + sector.first;
    const auto block = [&](int x) {
      return static_cast<std::int16_t>(above[x] + above[x + 1] + below[x] + below[x + 1]);
    };
    for (int k = 0; k < sector.places + kFarPlaces; ++k) even[k] = block(k * kColumnStep);
    for (int k = 0; k < sector.places; ++k) odd[k] = block(k * kColumnStep + 2);
    int fine_here = 0, coarse_here = 0;
    for (int k = 0; k < sector.places; ++k) {
      const int bend = std::abs(even[k] - 2 * odd[k] + even[k + 1]) - kNoise;
      const int difference = std::abs(even[k] - even[k + kFarPlaces]) - kNoise;
      fine_here += comparable[k] * std::max(0, bend);
      coarse_here += comparable[k] * std::max(0, difference);
    }
    comparable += sector.places;
    fine += fine_here;
    coarse += coarse_here;
  }
  return coarse > 0 ? static_cast<float>(fine) / static_cast<float>(coarse) : 0;
}

void VisionHealth::measure(const PanoramaView& panorama) {
  count(panorama);
  measure_brightness();
  measure_sectors(panorama);
}

void VisionHealth::count(const PanoramaView& panorama) {
  Checksum checksum{};
  for (int row = 0; row < geometry_.rows; row += kRowStep)
    add_row(panorama.row(row), geometry_.width, checksum);
  statistics_.checksum = std::accumulate(
      checksum.begin(), checksum.end(), std::uint64_t{0},
      [](std::uint64_t all, std::uint64_t part) { return all * 0x9e3779b97f4a7c15ULL + part; });
  for (auto& histogram : histograms_) histogram.fill(0);
  const auto count_runs = [&](const std::vector<Run>& runs) {
    for (const Run& run : runs) {
      const std::uint8_t* pixels = panorama.row(run.row);
      auto& histogram = histograms_[run.sector];
      for (int x = run.first; x < run.last; x += kColumnStep) ++histogram[pixels[x]];
    }
  };
  count_runs(above_);
  const std::uint32_t saturated_above = saturated();
  count_runs(ground_);
  saturated_ground_ = saturated() - saturated_above;
}

std::uint32_t VisionHealth::saturated() const {
  std::uint32_t pixels = 0;
  for (const Histogram& histogram : histograms_)
    pixels = std::accumulate(histogram.begin() + kSaturated, histogram.end(), pixels);
  return pixels;
}

void VisionHealth::measure_brightness() {
  Histogram all{};
  for (const Histogram& histogram : histograms_)
    std::transform(all.begin(), all.end(), histogram.begin(), all.begin(), std::plus<>());
  const double total = std::max(1.0, std::accumulate(all.begin(), all.end(), 0.0));
  double sum = 0;
  for (int level = 0; level < 256; ++level) sum += static_cast<double>(level) * all[level];
  Statistics& s = statistics_;
  s.mean = static_cast<float>(sum / total);
  s.median = static_cast<float>(quantile(all, 0.5));
  s.high = static_cast<float>(quantile(all, 0.95));
  s.saturated = static_cast<float>(saturated() / total);
  s.saturated_ground = share(saturated_ground_, ground_pixels_);
}

void VisionHealth::measure_sectors(const PanoramaView& panorama) {
  std::array<float, kSectors> spreads;
  std::uint32_t seen = 0, even = 0, sharp = 0;
  for (int i = 0; i < kSectors; ++i) {
    if (!sectors_[i].seen) continue;
    const auto low = static_cast<float>(quantile(histograms_[i], 0.05));
    const auto middle = static_cast<float>(quantile(histograms_[i], 0.5));
    const auto high = static_cast<float>(quantile(histograms_[i], 0.95));
    spreads[seen++] = high - low;
    if (high - low < std::max(kEvenLevels, kEvenSpread * middle)) {
      ++even;
    } else if (sharpness(panorama, sectors_[i]) > kSharpness) {
      ++sharp;
    }
  }
  statistics_.even_sectors = share(even, seen);
  statistics_.sharp_sectors = seen > even ? share(sharp, seen - even) : 1;
  std::sort(spreads.begin(), spreads.begin() + seen);
  statistics_.contrast = seen > 0 ? spreads[seen / 2] : 0;
}

VisionHealth::Reason VisionHealth::judge() {
  const Statistics& s = statistics_;
  repeats_ = s.checksum == last_checksum_ ? repeats_ + 1 : 0;
  last_checksum_ = s.checksum;
  if (s.high < kDarkHigh) return Reason::dark;
  if (s.saturated_ground > kGlareGround || s.saturated > kGlareAll ||
      (s.median > kVeiledMedian && s.contrast < kVeiledContrast))
    return Reason::glare;
  if (s.even_sectors >= kCoveredShare) return Reason::covered;
  if (s.sharp_sectors <= 1 - kSmearedShare) return Reason::smeared;
  return Reason::none;
}

VisionHealth::Reason VisionHealth::observe(const PanoramaView& panorama) {
  measure(panorama);
  Reason now = judge();
  if (now == Reason::none && repeats_ >= kRepeatsOfFrozen) now = Reason::frozen;
  good_frames_ = now == Reason::none ? std::min(good_frames_ + 1, kFramesToBelieve) : 0;
  if (now != Reason::none || good_frames_ == kFramesToBelieve) told_ = now;
  return told_;
}

}  // namespace bole
