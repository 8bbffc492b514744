#include <cstdio>
#include <memory>

#include <spdlog/spdlog.h>

#include "capture/camera_report.h"
#include "commands/commands.h"

namespace bole {
namespace {

void cameras(bool json) {
  std::vector<std::string> trouble;
  const std::vector<CameraInfo> found = list_cameras(trouble);
  for (const std::string& line : trouble) spdlog::warn("{}", line);
  std::fputs((json ? json_report(found) : text_report(found)).c_str(), stdout);
}

}  // namespace

void add_cameras(CLI::App& app) {
  auto json = std::make_shared<bool>(false);
  CLI::App* command =
      app.add_subcommand("cameras", "Lists the cameras that are there and what they can do");
  command->add_flag("--json", *json, "Print them as an array of JSON");
  command->callback([json] { cameras(*json); });
}

}  // namespace bole
