#include "capture/plugin.h"

#include <dlfcn.h>

#include <filesystem>
#include <stdexcept>

namespace bole {
namespace {

void* open_plugin(const std::string& file) {
  const std::filesystem::path programs =
      std::filesystem::read_symlink("/proc/self/exe").parent_path();
  std::string reason = "there is no such file beside the program or in its library folder";
  for (const std::filesystem::path& path :
       {programs / file, programs.parent_path() / BOLE_LIBDIR / "bole" / file}) {
    if (!std::filesystem::exists(path)) continue;
    if (void* plugin = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL)) return plugin;
    reason = ::dlerror();
  }
  throw std::runtime_error(file + " cannot be loaded: " + reason);
}

}  // namespace

void* load_plugin_symbol(const std::string& file, const std::string& symbol) {
  void* const plugin = open_plugin(file);
  const auto* version = static_cast<const char*>(::dlsym(plugin, "bole_plugin_version"));
  if (version == nullptr || std::string(version) != BOLE_VERSION) {
    throw std::runtime_error(file + " belongs to another version of bole than " BOLE_VERSION);
  }
  void* const found = ::dlsym(plugin, symbol.c_str());
  if (found == nullptr) throw std::runtime_error(file + " has no " + symbol);
  return found;
}

}  // namespace bole
