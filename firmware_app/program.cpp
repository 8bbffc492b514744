#include "program.h"

#include <fcntl.h>
#include <unistd.h>

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

// Else the first file that is opened takes the place of standard output.
void open_standard_streams() {
  for (int fd = STDIN_FILENO; fd <= STDERR_FILENO; ++fd) {
    if (::fcntl(fd, F_GETFD) < 0) ::open("/dev/null", O_RDWR);  // gets the lowest number free
  }
}

void add_version(CLI::App& app, const std::string& text) {
  app.set_version_flag("--version", text);
  for (CLI::App* command : app.get_subcommands({})) add_version(*command, text);
}

int fail(const char* name, const char* problem, int code) {
  std::fprintf(stderr, "%s: %s\n", name, problem);
  return code;
}

}  // namespace

int run_program(const char* name, const char* description, void (*set_up)(CLI::App&), int argc,
                char** argv) {
  open_standard_streams();
  CLI::App app{description, name};
  app.footer("Exit code: 0 done, 2 wrong usage or configuration, 1 anything else.");
  try {
    set_up_log();
    set_up(app);
    add_version(app, std::string(name) + " " + BOLE_VERSION);
    app.parse(argc, argv);
    flush_output();
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

void flush_output() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    throw std::runtime_error("standard output cannot be written");
  }
}

}  // namespace bole
