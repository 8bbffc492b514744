#include "commands/commands.h"
#include "program.h"

namespace {

void add_commands(CLI::App& app) {
  // None at all is refused last, so that a misspelt one is called by its name.
  app.require_subcommand(0, 1);
  app.final_callback([&app] {
    if (app.get_subcommands().empty()) throw CLI::RequiredError::Subcommand(1);
  });
  bole::add_calib(app);
  bole::add_cameras(app);
  bole::add_detect(app);
  bole::add_doctor(app);
  bole::add_eval(app);
  bole::add_grab(app);
  bole::add_listen(app);
  bole::add_lut(app);
  bole::add_publish_fake(app);
  bole::add_sim(app);
}

}  // namespace

int main(int argc, char** argv) {
  return bole::run_program("bolectl",
                           "The operator's tool of bole, which finds tree trunks around a robot",
                           add_commands, argc, argv);
}
