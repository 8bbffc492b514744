#include "commands/commands.h"
#include "program.h"

int main(int argc, char** argv) {
  CLI::App app{"The operator's tool of bole, which finds tree trunks around a robot", "bolectl"};
  app.require_subcommand(1);
  bole::add_cameras(app);
  bole::add_detect(app);
  bole::add_doctor(app);
  bole::add_eval(app);
  bole::add_grab(app);
  bole::add_listen(app);
  bole::add_lut(app);
  bole::add_publish_fake(app);
  bole::add_sim(app);
  return bole::run_program(app, argc, argv);
}
