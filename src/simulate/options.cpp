#include "simulate/options.h"

#include "base/errors.h"

namespace bole::simulate {
namespace {

SimOptions varied() {
  SimOptions o;
  o.frames_per_world = 1;
  o.trees_per_ha = {40, 1000};
  o.bright_share = {0.05F, 0.6F};
  o.crooked_share = {0, 0.8F};
  o.slope = {0, 0.25F};
  o.undulation = {0, 0.15F};
  o.attitude_deg = {0, 2};
  o.foot_cover = {0, 1};
  o.bushes_per_ha = {0, 900};
  o.clutter_per_ha = {0, 250};
  o.walls = {0, 3};
  o.exposure_stops = {-1.8F, 1.2F};
  o.contrast = {0.7F, 1.7F};
  o.fog = {0, 0.05F};
  o.glare = {0, 0.4F};
  o.blur_px = {0.2F, 1.6F};
  o.noise = {0.5F, 8};
  o.jpeg_quality = {50, 115};
  return o;
}

}  // namespace

SimOptions preset(std::string_view name) {
  if (name == "drive") return {};
  if (name == "varied") return varied();
  if (name == "treeless") {
    SimOptions o = varied();
    o.trees_per_ha = {0, 0};
    return o;
  }
  throw ConfigError("--preset", "", "\"" + std::string(name) + "\" is not known",
                    "must be one of: drive, varied, treeless");
}

}  // namespace bole::simulate
