#pragma once

namespace bole {

/// Shows on standard error how many of all frames are done: on a terminal only, and only where a
/// person has to wait.
void show_progress(int done, int all);

}  // namespace bole
