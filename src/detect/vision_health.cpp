#include "detect/vision_health.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <numeric>

namespace bole {
namespace {

constexpr int kRowStep = 6, kColumnStep = 4;
constexpr int kFramesToTell = 3;
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

// Of a row's whole words, going on from the rows before.
std::uint64_t checksum(const std::uint8_t* pixels, int width, std::uint64_t before) {
  std::uint64_t checksum = before;
  for (int x = 0; x + 8 <= width; x += 8) {
    std::uint64_t word;
    std::memcpy(&word, pixels + x, sizeof word);
    checksum = (checksum ^ word) * 0x9e3779b97f4a7c15ULL;
    checksum ^= checksum >> 32;
  }
  return checksum;
}

// The grey level below which `part` of the pixels lie.
int quantile(const Histogram& histogram, double part) {
  const double total = std::accumulate(histogram.begin(), histogram.end(), 0.0);
  double below = 0;
  for (int level = 0; level < 256; ++level) {
    below += histogram[level];
    if (below > part * total) return level;
  }
  return 255;
}

// Fine over coarse structure along the rows: how much the brightness bends from one pair of columns
// to the next, against how much it differs between pairs that lie far apart. What noise alone makes
// counts in neither.
float sharpness(const PanoramaView& panorama, const SeenMap& seen, int first, int last) {
  constexpr int kFar = 16;
  constexpr int kNoise = 8;  // in a sum of four pixels
  const int width = panorama.geometry->width;
  std::int64_t fine = 0, coarse = 0;
  for (int row = 2; row + 2 < panorama.geometry->rows; row += 2 * kRowStep) {
    const std::uint8_t* above = panorama.row(row);
    const std::uint8_t* below = panorama.row(row + 1);
    const std::uint8_t* ok = seen.pixels.data() + static_cast<std::size_t>(row) * width;
    for (int x = first; x + kFar + 2 <= last; x += kColumnStep) {
      if (!ok[x] || !ok[x + kFar]) continue;
      const auto block = [&](int at) {
        return above[at] + above[at + 1] + below[at] + below[at + 1];
      };
      fine += std::max(0, std::abs(block(x) - 2 * block(x + 2) + block(x + 4)) - kNoise);
      coarse += std::max(0, std::abs(block(x) - block(x + kFar)) - kNoise);
    }
  }
  return coarse > 0 ? static_cast<float>(fine) / static_cast<float>(coarse) : 0;
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
    : geometry_(geometry), seen_(seen) {
  for (int i = 0; i < kSectors; ++i) {
    Sector& sector = sectors_[i];
    sector.first = geometry.width * i / kSectors;
    sector.last = geometry.width * (i + 1) / kSectors;
    int seen_columns = 0;
    for (int x = sector.first; x < sector.last; ++x)
      seen_columns += seen.columns[x].last - seen.columns[x].first > geometry.rows / 4;
    sector.seen = 2 * seen_columns > sector.last - sector.first;
  }
}

void VisionHealth::measure(const PanoramaView& panorama) {
  count(panorama);
  measure_brightness();
  measure_sectors(panorama);
}

void VisionHealth::count(const PanoramaView& panorama) {
  const int width = geometry_.width;
  const int horizon = static_cast<int>(std::ceil(geometry_.horizon_row()));
  statistics_.checksum = 0;
  ground_ = saturated_ground_ = 0;
  for (auto& histogram : histograms_) histogram.fill(0);
  for (int row = 0; row < geometry_.rows; row += kRowStep) {
    const std::uint8_t* pixels = panorama.row(row);
    const std::uint8_t* seen = seen_.pixels.data() + static_cast<std::size_t>(row) * width;
    statistics_.checksum = checksum(pixels, width, statistics_.checksum);
    for (int i = 0; i < kSectors; ++i) {
      auto& histogram = histograms_[i];
      std::uint32_t bright = 0, count = 0;
      for (int x = sectors_[i].first; x < sectors_[i].last; x += kColumnStep) {
        if (!seen[x]) continue;
        ++histogram[pixels[x]];
        ++count;
        bright += pixels[x] >= kSaturated;
      }
      if (row < horizon) continue;
      ground_ += count;
      saturated_ground_ += bright;
    }
  }
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
  s.saturated =
      static_cast<float>(std::accumulate(all.begin() + kSaturated, all.end(), 0.0) / total);
  s.saturated_ground = share(saturated_ground_, ground_);
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
    } else if (sharpness(panorama, seen_, sectors_[i].first, sectors_[i].last) > kSharpness) {
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
  if (now == Reason::none && repeats_ >= kRepeatsOfFrozen) {
    now = Reason::frozen;  // has been seen in several frames already
    told_ = now;
  }
  if (now == told_) {
    coming_for_ = 0;
    return told_;
  }
  coming_for_ = now == coming_ ? coming_for_ + 1 : 1;
  coming_ = now;
  if (coming_for_ >= kFramesToTell) {
    told_ = now;
    coming_for_ = 0;
  }
  return told_;
}

}  // namespace bole
