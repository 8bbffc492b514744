#include <cstdio>
#include <memory>

#include "commands/commands.h"
#include "daemon_options.h"
#include "service/grab_frame.h"

namespace bole {
namespace {

void grab(const DaemonOptions& options, const std::string& out) {
  const GrabbedFrame grabbed = grab_frame(options.load(), out);
  std::printf("%s\n%s\n", grabbed.description.c_str(), grabbed.file.c_str());
}

}  // namespace

void add_grab(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("grab", "Writes one frame of a camera to a file, as it came");
  const auto options = add_daemon_options(*command);
  add_source_option(*command, options);
  const auto out = std::make_shared<std::string>("frame");
  command
      ->add_option("--out", *out,
                   "Path of the file, without ending, or a folder for one named frame")
      ->type_name("PATH")
      ->capture_default_str();
  command->callback([options, out] { grab(*options, *out); });
}

}  // namespace bole
