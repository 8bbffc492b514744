#include <cstdio>
#include <memory>
#include <optional>

#include "commands/commands.h"
#include "service/grab_frame.h"

namespace bole {
namespace {

struct Options {
  std::string config;
  std::string camera;
  std::string source;
  std::vector<std::string> set;
  std::string out = "frame";
};

void grab(const Options& options) {
  std::optional<std::filesystem::path> file;
  if (!options.config.empty()) file = options.config;
  std::vector<Setting> settings;
  const auto lay = [&](const char* key, const std::string& value) {
    if (!value.empty()) settings.push_back({key, toml_text(value)});
  };
  lay("camera.file", options.camera);
  lay("source.uri", options.source);
  for (const std::string& pair : options.set) settings.push_back(parse_setting(pair));

  const GrabbedFrame grabbed = grab_frame(load_daemon_config(file, settings), options.out);
  std::printf("%s\n%s\n%s\n", grabbed.description.c_str(), grabbed.raw.c_str(),
              grabbed.panorama.c_str());
}

}  // namespace

void add_grab(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("grab", "Writes one frame of a camera to files, raw and un-warped");
  command->add_option("--config", options->config, "Configuration of boled");
  command->add_option("--camera", options->camera, "camera.toml");
  command->add_option("--source", options->source, "v4l2:DEVICE, libcamera:ID or replay:PATH");
  command->add_option("--set", options->set, "KEY=VALUE of the configuration, as TOML")
      ->allow_extra_args(false);
  command->add_option("--out", options->out, "Path of the files, without ending")
      ->capture_default_str();
  command->callback([options] { grab(*options); });
}

}  // namespace bole
