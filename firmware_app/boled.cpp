#include "base/stop_signals.h"
#include "daemon_options.h"
#include "program.h"
#include "service/daemon.h"

int main(int argc, char** argv) {
  CLI::App app{"Finds tree trunks around a robot and publishes them", "boled"};
  const auto options = bole::add_daemon_options(app);
  bole::add_replay_options(app, options);
  bole::add_text_option(app, options, "--trace", "service.trace",
                        "Write where the time of frames goes, for chrome://tracing");
  app.callback([&] {
    const bole::DaemonConfig config = options->load();
    const bole::StopSignals stop;
    bole::run_daemon(config, BOLE_VERSION, stop.fd());
  });
  return bole::run_program(app, argc, argv);
}
