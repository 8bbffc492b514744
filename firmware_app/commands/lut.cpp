#include <algorithm>
#include <cstdio>
#include <memory>

#include "base/errors.h"
#include "commands/commands.h"
#include "warp/table_cache.h"

namespace bole {
namespace {

struct Options {
  std::string camera;
  std::string table;
  bool json = false;
};

void build(const Options& options) {
  const Camera camera = load_camera(options.camera);
  if (!options.table.empty()) {
    build_warp_table(camera).store(options.table);
    return;
  }
  const CachedTable cached = load_or_build_warp_table(camera, default_cache_directory());
  if (!cached.trouble.empty()) throw ConfigError("cache", "", cached.trouble, "give --out FILE");
}

void info(const Options& options) {
  const Camera camera = load_camera(options.camera);
  const WarpTable table = WarpTable::load(options.table, camera.digest);
  const PanoramaGeometry& panorama = table.panorama();
  const SeenMap seen = table.seen();
  const auto pixels = std::count(seen.pixels.begin(), seen.pixels.end(), std::uint8_t{1});
  const char* form =
      options.json
          ? "{\"image_width\":%d,\"image_height\":%d,\"panorama_width\":%d,"
            "\"panorama_rows\":%d,\"columns\":%d,\"seen\":%.3f,\"bytes\":%zu,"
            "\"camera\":\"%08x\"}\n"
          : "image %d x %d, panorama %d x %d of %d columns, %.3f of it seen, %zu bytes, camera "
            "%08x\n";
  std::printf(form, table.image_size().width, table.image_size().height, panorama.width,
              panorama.rows, panorama.columns,
              static_cast<double>(pixels) / static_cast<double>(seen.pixels.size()),
              table.bytes().size(), table.digest());
}

}  // namespace

void add_lut(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("lut", "Builds and describes warp tables");
  command->require_subcommand(1);

  CLI::App* build_command = command->add_subcommand("build", "Builds a camera's table");
  build_command->add_option("--camera", options->camera, "camera.toml")
      ->type_name("FILE")
      ->required();
  build_command->add_option("--out", options->table, "File to write; by default kept in the cache")
      ->type_name("FILE");
  build_command->callback([options] { build(*options); });

  CLI::App* info_command =
      command->add_subcommand("info", "Checks a table against its camera and describes it");
  info_command->add_option("--camera", options->camera, "camera.toml")
      ->type_name("FILE")
      ->required();
  info_command->add_option("TABLE", options->table, "The table's file")->type_name("")->required();
  info_command->add_flag("--json", options->json, "Print one line of JSON");
  info_command->callback([options] { info(*options); });
}

}  // namespace bole
