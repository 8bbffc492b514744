#include "evaluate/detections.h"

#include <array>
#include <charconv>

#include <nlohmann/json.hpp>

namespace bole {

double as_printed(float value) {
  std::array<char, 32> text{};
  const char* end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  double number = 0;
  std::from_chars(text.data(), end, number);
  return number;
}

std::string detection_line(const std::string& file, std::span<const Tree> trees) {
  nlohmann::ordered_json line = {{"file", file}, {"trees", nlohmann::ordered_json::array()}};
  for (const Tree& tree : trees) {
    line["trees"].push_back({{"id", tree.id},
                             {"bearing", as_printed(tree.bearing)},
                             {"range", as_printed(tree.range)},
                             {"diameter", as_printed(tree.diameter)},
                             {"score", as_printed(tree.score)},
                             {"bearing_sigma", as_printed(tree.bearing_sigma)},
                             {"range_sigma", as_printed(tree.range_sigma)},
                             {"diameter_sigma", as_printed(tree.diameter_sigma)},
                             {"base_elevation", as_printed(tree.base_elevation)},
                             {"angular_width", as_printed(tree.angular_width)}});
  }
  return line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string error_line(const std::string& file, const std::string& error) {
  return nlohmann::ordered_json{{"file", file}, {"error", error}}.dump(
      -1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace bole
