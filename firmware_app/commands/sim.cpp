#include <filesystem>
#include <memory>
#include <string>

#include "base/errors.h"
#include "commands/commands.h"
#include "commands/progress.h"
#include "simulate/invented_camera.h"
#include "simulate/recording.h"

namespace bole {
namespace {

namespace fs = std::filesystem;

// That of the source tree where we stand in it, else the one installed, or in the build folder.
std::string example_camera() {
  const fs::path file = "calib/example/camera.toml";
  if (fs::exists(file)) return file;
  return fs::read_symlink("/proc/self/exe").parent_path().parent_path() / BOLE_DATADIR / "bole" /
         file;
}

struct SimCommand {
  std::string out;
  std::string camera = example_camera();
  std::string preset = "drive";
  std::string impairment;
  simulate::RecordingOptions recording;
};

void simulate_drive(SimCommand command) {
  command.recording.world = simulate::preset(command.preset);
  if (!command.impairment.empty()) {
    command.recording.impairment = simulate::impairment_from_name(command.impairment);
    if (!command.recording.impairment) {
      throw ConfigError("--impair", "", "\"" + command.impairment + "\" is not known",
                        "must be one of: darkness, glare, covered, smeared, frozen");
    }
  }
  const Camera camera = command.camera == "invented"
                            ? simulate::invent_camera(command.out, command.recording.seed)
                            : load_camera(command.camera);
  simulate::record(command.out, camera, command.recording,
                   [&](int done) { show_progress(done, command.recording.frames); });
}

}  // namespace

void add_sim(CLI::App& app) {
  auto options = std::make_shared<SimCommand>();
  CLI::App* command = app.add_subcommand(
      "sim", "Renders a robot's drive through a wood, with the truth, ready to be replayed");
  command->add_option("--out", options->out, "Folder to write")->type_name("FOLDER")->required();
  command->add_option("--frames", options->recording.frames, "How many, ten a second")
      ->type_name("FRAMES")
      ->required()
      ->check(CLI::Range(1, 100000));
  command->add_option("--seed", options->recording.seed, "All that is random follows from it")
      ->type_name("NUMBER")
      ->required();
  command
      ->add_option("--camera", options->camera,
                   "camera.toml to see through, or \"invented\" for one that follows from the seed")
      ->type_name("FILE")
      ->capture_default_str();
  command->add_option("--format", options->recording.format, "png, jpg or a raw pixel format")
      ->type_name("FORMAT")
      ->capture_default_str();
  command->add_option("--preset", options->preset, "drive, varied or treeless")
      ->type_name("PRESET")
      ->capture_default_str();
  command
      ->add_option("--impair", options->impairment,
                   "darkness, glare, covered, smeared or frozen, from the first frame on")
      ->type_name("HOW");
  command->callback([options] { simulate_drive(*options); });
}

}  // namespace bole
