#include "evaluate/truth.h"

#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "base/files.h"

namespace bole {
namespace {

using nlohmann::json;

constexpr std::size_t kMostBytes = std::size_t{1} << 28;

TruthTree tree_of(const json& value) {
  TruthTree tree;
  tree.id = value.value("id", -1);
  tree.bearing = value.at("bearing");
  if (value.contains("range")) {
    tree.range = value.at("range").get<double>();
    tree.diameter = value.at("diameter");
    tree.visible = value.at("visible");
  } else {
    tree.angular_width = value.at("angular_width");
    tree.base_elevation = value.value("base_elevation", 0.0);
  }
  return tree;
}

// As in score.py: a frame is metric when all of its trees are and the file does not say otherwise;
// a frame without trees needs the file's word for it.
bool metric(const TruthFrame& frame, const json& file) {
  for (const TruthTree& tree : frame.trees) {
    if (!tree.range) return false;
  }
  return file.value("metric", !frame.trees.empty());
}

}  // namespace

Truth parse_truth(const std::string& text, const std::string& file) {
  std::string key;
  try {
    const json root = json::parse(text);
    Truth truth;
    const json mount = root.value("mount", json::object());
    truth.height = root.value("height_m", mount.value("height_m", 1.0));
    for (const json& value : root.at("frames")) {
      key = "frames[" + std::to_string(truth.frames.size()) + "]";
      TruthFrame& frame = truth.frames.emplace_back();
      frame.file = value.at("file");
      frame.utime = value.value("utime", std::int64_t{0});
      // What has no time follows nothing.
      const int alone = -static_cast<int>(truth.frames.size());
      frame.world = value.value("world", value.contains("utime") ? 0 : alone);
      frame.exhaustive = value.value("exhaustive", true);
      for (const json& tree : value.at("trees")) frame.trees.push_back(tree_of(tree));
      frame.metric = metric(frame, root);
    }
    return truth;
  } catch (const json::exception& error) {
    const std::string text_of_error = error.what();  // "[json.exception...] what is wrong"
    throw ConfigError(file, key, text_of_error.substr(text_of_error.find(' ') + 1),
                      "give a truth.json as bolectl sim writes it");
  }
}

Truth read_truth(const std::filesystem::path& file) {
  return parse_truth(read_text_file(file, kMostBytes), file.string());
}

}  // namespace bole
