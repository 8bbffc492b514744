#include "daemon_options.h"
#include "program.h"
#include "service/daemon.h"

namespace {

void add_options(CLI::App& app) {
  const auto options = bole::add_daemon_options(app);
  bole::add_source_option(app, options);
  bole::add_publish_option(app, options);
  bole::add_text_option(app, options, "--trace", "service.trace", "FILE",
                        "Write where the time of frames goes, for chrome://tracing");
  bole::add_replay_options(app, options);
  app.callback([options] { bole::run_daemon(options->load(), BOLE_VERSION); });
}

}  // namespace

int main(int argc, char** argv) {
  return bole::run_program("boled", "Finds tree trunks around a robot and publishes them",
                           add_options, argc, argv);
}
