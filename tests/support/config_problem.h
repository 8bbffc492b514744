#pragma once

#include <string>

#include "base/errors.h"

namespace bole::test {

/// What reading a configuration file complains of; "none" when it is taken.
template <class Read>
std::string config_problem(const Read& read) {
  try {
    read();
    return "none";
  } catch (const ConfigError& error) {
    return error.what();
  }
}

}  // namespace bole::test
