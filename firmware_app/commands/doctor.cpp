#include "service/doctor.h"

#include <cstdio>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "commands/commands.h"
#include "daemon_options.h"

namespace bole {
namespace {

void doctor(const DaemonOptions& options, bool json) {
  int problems = 0;
  for (const Finding& finding : examine(options.load())) {
    problems += finding.good ? 0 : 1;
    if (json) {
      std::puts(nlohmann::json{
          {"check", finding.check}, {"good", finding.good}, {"detail", finding.detail}}
                    .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)
                    .c_str());
    } else {
      std::printf("%-4s %s: %s\n", finding.good ? "good" : "BAD", finding.check.c_str(),
                  finding.detail.c_str());
    }
  }
  if (problems > 0) throw std::runtime_error("problems found: " + std::to_string(problems));
}

}  // namespace

void add_doctor(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("doctor", "Checks what boled needs and says how to mend what is missing");
  const auto options = add_daemon_options(*command);
  add_source_option(*command, options);
  add_publish_option(*command, options);
  const auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "Print a line of JSON a check");
  command->callback([options, json] { doctor(*options, *json); });
}

}  // namespace bole
