#include <poll.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include <spdlog/spdlog.h>

#include "base/clock.h"
#include "base/errors.h"
#include "base/stop_signals.h"
#include "commands/commands.h"
#include "daemon_options.h"
#include "geometry/angles.h"
#include "program.h"
#include "publish/decoder.h"
#include "publish/json_line.h"
#include "publish/lcm_subscriber.h"
#include "publish/stream_figures.h"
#ifdef BOLE_ZENOH
#include "publish/zenoh_session.h"
#endif

namespace bole {
namespace {

constexpr std::chrono::seconds kPatience{3};  // until silence is worth a word

struct ListenOptions {
  bool zenoh = false;  // else LCM
  std::int64_t count = 0;
  bool json = false;
};

const char* state_name(std::int8_t state) {
  switch (state) {
    case status_t::STATE_STARTING:
      return "starting";
    case status_t::STATE_OPENING:
      return "opening";
    case status_t::STATE_STREAMING:
      return "streaming";
    case status_t::STATE_STALLED:
      return "stalled";
    case status_t::STATE_NO_CAMERA:
      return "no camera";
    case status_t::STATE_STOPPING:
      return "stopping";
    default:
      return "in an unknown state";
  }
}

void print(const tree_list_t& list) {
  std::printf("%s %lld:%s%s %d trees", list.camera.c_str(), static_cast<long long>(list.seq),
              (list.flags & tree_list_t::FLAG_DEGRADED) != 0 ? " cannot see well," : "",
              (list.flags & tree_list_t::FLAG_TRUNCATED) != 0 ? " truncated," : "", list.num_trees);
  for (const tree_t& tree : list.trees) {
    std::printf("; #%d %+.1f deg %.2f m, %.2f m thick (%.2f)", tree.id,
                static_cast<double>(tree.bearing) * 180 / kPi, static_cast<double>(tree.range),
                static_cast<double>(tree.diameter), static_cast<double>(tree.score));
  }
  std::printf("\n");
}

void print(const status_t& status) {
  std::string text = status.camera + " is " + state_name(status.state);
  if (!status.state_reason.empty()) text += " (" + status.state_reason + ")";
  if (status.degraded != 0) text += ", cannot see well: " + status.degraded_reason;
  std::printf("%s; %.1f frames/s, %.1f lists/s, latency p99 %.2f ms\n", text.c_str(),
              static_cast<double>(status.frame_rate), static_cast<double>(status.list_rate),
              static_cast<double>(status.latency_p99_ms));
}

// Prints what arrives and keeps the figures of each stream, by its channel and camera or its key.
class Listener {
 public:
  explicit Listener(const ListenOptions& options) : options_(options) {}

  void receive(const std::string& stream, MessageKind kind, std::span<const std::byte> bytes) {
    heard_ = true;
    try {
      if (kind == MessageKind::trees) {
        const tree_list_t list = decode_tree_list(bytes);
        figures_of(stream, list.camera).add(list, SystemClock().mono_ns());
        ++lists_;
        show(list, std::string());
      } else {
        show(decode_status(bytes));
      }
    } catch (const WireError& error) {
      figures_[stream].add_foreign();
      const std::string text = stream + " " + error.what();
      if (named_.size() < kMostNamed && named_.insert(text).second) spdlog::warn("{}", text);
    }
    flush_output();  // a reader that has gone ends us
  }

  /// True once: when nothing at all has come for a while.
  bool worries() {
    const bool too_long = std::chrono::steady_clock::now() - start_ > kPatience;
    return !heard_ && too_long && !std::exchange(worried_, true);
  }

  bool done() const { return options_.count > 0 && lists_ >= options_.count; }

  void summarize() const {
    for (const auto& [stream, figures] : figures_) {
      std::printf("%s\n", options_.json ? figures.json(stream).c_str()
                                        : (stream + ": " + figures.text()).c_str());
    }
  }

 private:
  static constexpr std::size_t kMostNamed = 100;

  // All cameras share LCM's channel, but each counts for itself. A key of Zenoh's names its camera.
  StreamFigures& figures_of(const std::string& stream, const std::string& camera) {
    const bool shared = stream == kTreesChannel && figures_.size() < kMostNamed;
    return figures_[shared ? stream + " " + camera : stream];
  }

  template <typename Message, typename... File>
  void show(const Message& message, const File&... file) {
    if (!options_.json) return print(message);
    write_json_line(message, file..., line_);
    std::fputs(line_.c_str(), stdout);
  }

  const ListenOptions& options_;
  std::map<std::string, StreamFigures> figures_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  bool heard_ = false;
  bool worried_ = false;
  std::int64_t lists_ = 0;
  std::set<std::string> named_;
  std::string line_;
};

void listen_lcm(const LcmUrl& url, Listener& listener, const StopSignals& stop) {
  LcmSubscriber lcm(url, [&](MessageKind kind, std::span<const std::byte> bytes) {
    listener.receive(kind == MessageKind::trees ? kTreesChannel : kStatusChannel, kind, bytes);
  });
  std::array<pollfd, 2> waits{pollfd{stop.fd(), POLLIN, 0}, pollfd{lcm.fd(), POLLIN, 0}};
  while (!listener.done()) {
    if (::poll(waits.data(), waits.size(), 500) < 0) continue;
    if (waits[0].revents != 0) break;
    if (waits[1].revents != 0) lcm.handle();
    if (!listener.worries()) continue;
    spdlog::warn("nothing on {} yet; is boled running, does it publish to lcm, at this address{}?",
                 url.text(),
                 url.ttl == 0 ? ", and on this machine (its ttl=0 reaches no other)" : "");
  }
}

#ifdef BOLE_ZENOH
void take(const ZenohMessage& message, Listener& listener) {
  if (message.event != ZenohMessage::Event::sample) {
    spdlog::info("{} {}", message.key,
                 message.event == ZenohMessage::Event::alive ? "has come" : "has gone");
  } else if (message.key.ends_with("/trees")) {
    listener.receive(message.key, MessageKind::trees, message.payload);
  } else if (message.key.ends_with("/status")) {
    listener.receive(message.key, MessageKind::status, message.payload);
  }
}

// Its own words on why it does not connect: the first ones are the most precise.
std::string told_by_zenoh(const ZenohState& state) {
  const std::vector<ZenohWarning> warnings = ZenohSession::take_warnings();
  return "(" + (warnings.empty() ? state.error : warnings.front().text) + ")";
}

// `config`: of the daemon, but connecting to --zenoh; its TLS holds here too.
void listen_zenoh(ZenohConfig config, Listener& listener, const StopSignals& stop) {
  config.mode = "client";
  config.listen.clear();
  const std::string& endpoint = config.connect.front();
  ZenohSession session(config, std::nullopt, {"bole/**"});
  pollfd stopped{stop.fd(), POLLIN, 0};
  bool told = false;
  while (!listener.done() && ::poll(&stopped, 1, 0) <= 0) {
    for (const ZenohMessage& message : session.receive(std::chrono::milliseconds(200))) {
      if (!listener.done()) take(message, listener);
    }
    const ZenohState state = session.state();
    const bool refused = !state.connected() && !state.error.empty();
    if (refused && !told) {
      spdlog::warn("cannot connect to {} yet; is boled running there, does it publish to zenoh? {}",
                   endpoint, told_by_zenoh(state));
    } else if (!refused && listener.worries()) {
      spdlog::warn("nothing on {} yet; is boled running, and does it publish to zenoh?", endpoint);
    }
    told = !state.connected() && (told || refused);
  }
}
#else
void listen_zenoh(const ZenohConfig& /*config*/, Listener& /*listener*/,
                  const StopSignals& /*stop*/) {
  throw ConfigError("--zenoh", "", "is not in this build", "install cargo and build again");
}
#endif

void listen(const DaemonConfig& config, const ListenOptions& options) {
  const StopSignals stop;
  Listener listener(options);
  if (options.zenoh) {
    listen_zenoh(config.zenoh, listener, stop);
  } else {
    listen_lcm(config.lcm, listener, stop);
  }
  listener.summarize();
}

}  // namespace

void add_listen(CLI::App& app) {
  auto options = std::make_shared<ListenOptions>();
  CLI::App* command = app.add_subcommand("listen", "Shows the lists and states on a bus");
  const auto daemon = add_config_options(*command);
  CLI::Option* lcm = add_text_option(*command, daemon, "--lcm", "lcm.url", "URL",
                                     "LCM's address; by default that of the configuration");
  command
      ->add_option_function<std::string>(
          "--zenoh",
          [options, daemon](const std::string& endpoint) {
            options->zenoh = true;
            daemon->named.push_back(
                {"--zenoh", {"zenoh.connect", "[" + toml_text(endpoint) + "]"}});
          },
          "Listen on Zenoh instead, as at tcp/127.0.0.1:7447, with TLS as the configuration has it")
      ->type_name("ENDPOINT")
      ->excludes(lcm);
  command->add_option("--count", options->count, "Stop after so many lists; 0: never")
      ->type_name("LISTS")
      ->capture_default_str()
      ->check(CLI::Range(0, 1'000'000'000));
  command->add_flag("--json", options->json,
                    "Print a line of JSON a message, and one a stream at the end");
  command->callback([options, daemon] { listen(daemon->load(), *options); });
}

}  // namespace bole
