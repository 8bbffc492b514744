#pragma once

#include <string>

#include "base/errors.h"

namespace bole::test {

/// What a call that reads or uses a configuration complains of; "none" when it is taken.
template <class Call>
std::string config_problem(const Call& call) {
  try {
    call();
    return "none";
  } catch (const ConfigError& error) {
    return error.what();
  }
}

}  // namespace bole::test
