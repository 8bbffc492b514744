#include "program.h"

#include <cstdio>
#include <cstdlib>

#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "base/errors.h"

namespace bole {
namespace {

// The level as the journal reads it at the start of a line: <3> error ... <7> debug.
class JournalLevel : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm& /*time*/,
              spdlog::memory_buf_t& out) override {
    constexpr std::string_view digits = "776432";
    const auto level = std::min<std::size_t>(message.level, digits.size() - 1);
    for (const char c : {'<', digits[level], '>'}) out.push_back(c);
  }
  std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<JournalLevel>();
  }
};

// Standard output is for lists and results; logs go to standard error. The journal adds the time
// itself.
void set_up_log() {
  auto logger = spdlog::stderr_color_mt("bole");
  auto formatter = std::make_unique<spdlog::pattern_formatter>();
  if (std::getenv("JOURNAL_STREAM") != nullptr) {
    formatter->add_flag<JournalLevel>('*').set_pattern("%*%v");
  } else {
    formatter->set_pattern("%H:%M:%S.%e %^%l%$: %v");
  }
  logger->set_formatter(std::move(formatter));
  spdlog::set_default_logger(std::move(logger));
}

int fail(const char* name, const char* problem, int code) {
  std::fprintf(stderr, "%s: %s\n", name, problem);
  return code;
}

}  // namespace

int run_program(const char* name, const char* description, void (*set_up)(CLI::App&), int argc,
                char** argv) {
  CLI::App app{description, name};
  try {
    set_up_log();
    app.set_version_flag("--version", std::string(name) + " " + BOLE_VERSION);
    set_up(app);
    app.parse(argc, argv);
    return EXIT_SUCCESS;
  } catch (const CLI::Success& shown) {  // --help, --version
    return app.exit(shown);
  } catch (const CLI::ParseError& error) {
    return fail(name, (std::string(error.what()) + "; see --help").c_str(), 2);
  } catch (const ConfigError& error) {
    return fail(name, error.what(), 2);
  } catch (const std::exception& error) {
    return fail(name, error.what(), 1);
  }
}

}  // namespace bole
