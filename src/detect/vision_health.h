#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "geometry/panorama_view.h"

namespace bole {

/// Whether a camera can see well enough for its lists to mean something: an empty list from one
/// that cannot is not 'no trees'. Judged from cheap statistics of the panoramas that detection
/// works on anyway (every sixth row and fourth column of what is seen).
class VisionHealth {
 public:
  enum class Reason : std::uint8_t { none, dark, glare, covered, smeared, frozen };

  /// `seen` is read here and no more.
  VisionHealth(const PanoramaGeometry& geometry, const SeenMap& seen);

  /// What is wrong with the view as of this frame, the gravest reason first. It is told at once,
  /// and taken back after three good frames running: of one frame too many called bad a planner
  /// loses little, of one too few it may lose the robot.
  ///
  ///   dark     hardly any grey level left to tell things apart
  ///   glare    saturated, or veiled to one bright grey, over much of the panorama
  ///   covered  a quarter of the bearings or more shows one even grey from top to bottom
  ///   smeared  a quarter of the bearings or more shows contrasts, but only blurred ones
  ///   frozen   four frames running are equal to the last bit. A sensor's noise makes that
  ///            impossible for a camera that works; a folder that replays one picture over and over
  ///            is rightly called frozen, too
  Reason observe(const PanoramaView& panorama);

  static constexpr int kSectors = 16;

  /// What a reason is judged from; for tests and those who set the limits.
  struct Statistics {
    float mean = 0;              ///< grey levels
    float median = 0, high = 0;  ///< grey levels: half, and 95 %, of the pixels lie below
    float saturated_ground = 0;  ///< share of the pixels below the horizon
    float saturated = 0;         ///< share of all pixels
    float even_sectors = 0;      ///< share of the seen sectors without contrast
    float sharp_sectors = 0;     ///< share of the other sectors with fine contrast
    float contrast = 0;          ///< median over the sectors of the spread of grey levels
    std::uint64_t checksum = 0;
  };
  const Statistics& statistics() const { return statistics_; }

 private:
  void measure(const PanoramaView& panorama);
  void count(const PanoramaView& panorama);
  void measure_brightness();
  void measure_sectors(const PanoramaView& panorama);
  Reason judge();

  struct Sector {
    int first = 0, last = 0;  // columns
    bool seen = false;
    // Of each row where sharpness is read, one after the other, and each of its `places`: 1 where
    // all that is compared is seen, else 0.
    int places = 0;
    std::vector<std::uint8_t> comparable;
  };
  struct Run {  // every kColumnStep-th of these columns is seen
    int row = -1, sector = 0, first = 0, last = 0;
  };
  void find_runs(const SeenMap& seen);
  void find_places(const SeenMap& seen, Sector& sector) const;
  float sharpness(const PanoramaView& panorama, const Sector& sector);
  std::uint32_t saturated() const;

  PanoramaGeometry geometry_;
  std::array<Sector, kSectors> sectors_;
  std::vector<Run> above_, ground_;       // the horizon, and below it
  std::uint32_t ground_pixels_ = 0;       // of the runs below it
  std::vector<std::int16_t> even_, odd_;  // of one row and sector: see sharpness
  std::array<std::array<std::uint32_t, 256>, kSectors> histograms_{};
  std::uint32_t saturated_ground_ = 0;  // pixels
  Statistics statistics_;
  std::uint64_t last_checksum_ = 0;
  int repeats_ = 0;
  Reason told_ = Reason::none;
  int good_frames_ = 0;  // running
};

/// "dark", "glare", ...; empty for none.
std::string_view name(VisionHealth::Reason reason);

}  // namespace bole
