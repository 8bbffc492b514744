#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "evaluate/camera_check.h"
#include "evaluate/drawing.h"
#include "geometry/angles.h"

namespace bole {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kLeastShown = 0.05;  // pixels a degree that do not print as none

Json json_of(const CameraCheck::Error& error) {
  return {{"mean_px", error.mean_px}, {"most_px", error.most_px}};
}

Json json_of(const CameraCheck::NearestGround& ground) {
  return {{"least_m", ground.least}, {"median_m", ground.median}, {"p95_m", ground.p95}};
}

std::string in_degrees(double angle, int digits = 0) { return fixed(degrees(angle), digits); }

std::string optics_line(const CameraCheck& check) {
  std::string line = check.model + ", " + shown(check.image) + " pixels, " +
                     fixed(100 * check.masked, 0) + " % masked; pixel to ray and back " +
                     fixed(check.there_and_back.most_px, 4) + " px at most";
  if (check.inverse) {
    line += ", by the file's inverse polynomial " + fixed(check.inverse->mean_px, 2) +
            " px on average, " + fixed(check.inverse->most_px, 1) + " at most";
  }
  return line;
}

std::string panorama_line(const CameraCheck& check) {
  const PanoramaGeometry& p = check.panorama;
  std::string line = shown({p.width, p.rows}) + " pixels of " + std::to_string(p.columns) +
                     " columns, " + fixed(100 * check.seen, 0) + " % of it seen, up to " +
                     in_degrees(check.highest_seen) + " degrees";
  if (!p.wraps()) {
    line += ", bearings " + in_degrees(p.bearing_of_column(p.width - 0.5)) + " to " +
            in_degrees(p.bearing_of_column(-0.5));
  }
  return line;
}

std::string blind_line(const CameraCheck& check) {
  if (check.blind.empty()) return "none";
  std::string line;
  for (const CameraCheck::Arc& arc : check.blind) {
    if (!line.empty()) line += ", ";
    line += in_degrees(arc.from, 1) + " to " + in_degrees(arc.to, 1);
  }
  return line + " degrees";
}

std::string ground_line(const CameraCheck& check) {
  if (!check.nearest_ground) return "none";
  return "from " + fixed(check.nearest_ground->median, 2) + " m on (" +
         fixed(check.nearest_ground->least, 2) + " to " + fixed(check.nearest_ground->p95, 2) +
         " at 95 % of bearings)";
}

std::string resolution_line(const CameraCheck& check) {
  std::string line = fixed(check.columns_a_degree, 1) + " columns a degree, ";
  line += check.pixels_a_degree >= kLeastShown
              ? fixed(check.pixels_a_degree, 1) + " pixels at the horizon"
              : "no pixel at the horizon";
  for (const CameraCheck::RowWorth& worth : check.row_worth) {
    line += (worth.range == check.row_worth.front().range ? "; a row is " : ", ") +
            fixed(worth.metres, 3) + " m at " + fixed(worth.range, 0) + " m";
  }
  return line;
}

}  // namespace

std::string to_json(const CameraCheck& check) {
  Json blind = Json::array(), rows = Json::array();
  for (const CameraCheck::Arc& arc : check.blind) {
    blind.push_back({degrees(arc.from), degrees(arc.to)});
  }
  for (const CameraCheck::RowWorth& worth : check.row_worth) {
    rows.push_back({{"range_m", worth.range}, {"metres", worth.metres}});
  }
  const Json json = {
      {"model", check.model},
      {"image_width", check.image.width},
      {"image_height", check.image.height},
      {"masked", check.masked},
      {"there_and_back", json_of(check.there_and_back)},
      {"no_way_back", check.no_way_back},
      {"inverse_polynomial", check.inverse ? json_of(*check.inverse) : Json(nullptr)},
      {"columns", check.panorama.columns},
      {"panorama_width", check.panorama.width},
      {"panorama_rows", check.panorama.rows},
      {"seen", check.seen},
      {"blind_deg", blind},
      {"highest_seen_deg", degrees(check.highest_seen)},
      {"nearest_ground", check.nearest_ground ? json_of(*check.nearest_ground) : Json(nullptr)},
      {"columns_a_degree", check.columns_a_degree},
      {"pixels_a_degree", check.pixels_a_degree},
      {"row_worth", rows},
      {"narrowest_trunk_columns", check.narrowest_trunk},
      {"warnings", check.warnings}};
  return json.dump();
}

std::string to_text(const CameraCheck& check) {
  std::string text = "camera      " + optics_line(check) + "\npanorama    " + panorama_line(check) +
                     "\nblind       " + blind_line(check) + "\nground      " + ground_line(check) +
                     "\nresolution  " + resolution_line(check) + "\nthin trunk  " +
                     fixed(check.narrowest_trunk, 1) +
                     " columns: the thinnest searched one at the farthest range";
  for (const std::string& warning : check.warnings) text += "\nwarning     " + warning;
  return text;
}

}  // namespace bole
