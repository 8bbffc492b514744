#pragma once

#include <string>

namespace bole {

/// The symbol `symbol` of the plug-in `file` ("bole_x.so"), which is looked for beside the running
/// program (the build tree) and then in the folder `bole` of the installation's library folder. It
/// stays loaded until the program ends. Throws std::runtime_error with the reason when it is not
/// there, cannot be loaded, or was built for another version of bole.
void* load_plugin_symbol(const std::string& file, const std::string& symbol);

}  // namespace bole

/// Each plug-in has this line once: whose plug-in it is.
#define BOLE_PLUGIN \
  extern "C" __attribute__((visibility("default"))) const char bole_plugin_version[] = BOLE_VERSION
