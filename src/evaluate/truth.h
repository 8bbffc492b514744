#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace bole {

/// A marked trunk, as in truth.json. Where a range is marked so are diameter and visible share.
struct TruthTree {
  int id = -1;  ///< the same in all frames of a drive; -1 where trees have none
  double bearing = 0;
  std::optional<double> range;  ///< metres, to the axis
  double diameter = 0;          ///< metres
  double visible = 0;           ///< share of the trunk that can be seen
  double base_elevation = 0;    ///< radians; given where the range is not
  double angular_width = 0;     ///< radians; given where the range is not
};

struct TruthFrame {
  std::string file;
  std::int64_t utime = 0;  ///< microseconds; of frames of a drive
  int world = 0;           ///< frames of one world follow each other; one without time is alone
  bool exhaustive = true;  ///< every trunk is marked; else only recall counts
  /// Trees are judged by position; else by bearing alone.
  bool metric = false;
  std::vector<TruthTree> trees;
};

struct Truth {
  double height = 1;  ///< metres, of the viewpoint
  std::vector<TruthFrame> frames;
};

/// Reads truth.json. Throws ConfigError for what is missing or damaged.
Truth read_truth(const std::filesystem::path& file);
Truth parse_truth(const std::string& text, const std::string& file);

}  // namespace bole
