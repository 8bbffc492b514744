#include "commands/progress.h"

#include <unistd.h>

#include <cstdio>

namespace bole {

void show_progress(int done, int all) {
  if (::isatty(STDERR_FILENO) == 0 || all < 10) return;
  std::fprintf(stderr, "\rframe %d of %d%s", done, all, done == all ? "\n" : "");
}

}  // namespace bole
