#include <poll.h>

#include <cstdio>
#include <memory>
#include <set>

#include <spdlog/spdlog.h>

#include "base/clock.h"
#include "base/stop_signals.h"
#include "commands/commands.h"
#include "publish/decoder.h"
#include "publish/json_line.h"
#include "publish/lcm_subscriber.h"
#include "publish/stream_figures.h"

namespace bole {
namespace {

struct ListenOptions {
  std::string lcm_url = kDefaultLcmUrl;
  std::int64_t count = 0;
  bool json = false;
};

std::string_view state_name(std::int8_t state) {
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
      return "unknown";
  }
}

void print(const tree_list_t& list) {
  std::printf("%lld %s:%s%s %d trees", static_cast<long long>(list.seq), list.camera.c_str(),
              (list.flags & tree_list_t::FLAG_DEGRADED) != 0 ? " degraded," : "",
              (list.flags & tree_list_t::FLAG_TRUNCATED) != 0 ? " truncated," : "", list.num_trees);
  for (const tree_t& tree : list.trees) {
    std::printf("; #%d %+.1f deg %.2f m, %.2f m thick (%.2f)", tree.id, tree.bearing * 57.29578,
                tree.range, tree.diameter, tree.score);
  }
  std::printf("\n");
}

void print(const status_t& status) {
  std::printf("status %s: %.*s%s%s%s%s, %.1f frames/s, %.1f lists/s, latency p99 %.2f ms\n",
              status.camera.c_str(), static_cast<int>(state_name(status.state).size()),
              state_name(status.state).data(), status.state_reason.empty() ? "" : " (",
              status.state_reason.c_str(), status.state_reason.empty() ? "" : ")",
              status.degraded != 0 ? (", degraded: " + status.degraded_reason).c_str() : "",
              status.frame_rate, status.list_rate, status.latency_p99_ms);
}

// Prints what arrives and keeps the figures.
class Listener {
 public:
  explicit Listener(bool json) : json_(json) {}

  void receive(MessageKind kind, std::span<const std::byte> bytes) {
    try {
      if (kind == MessageKind::trees) {
        const tree_list_t list = decode_tree_list(bytes);
        figures_.add(list, SystemClock().mono_ns());
        show(list, "");
      } else {
        show(decode_status(bytes));
      }
    } catch (const WireError& error) {
      figures_.add_foreign();
      const std::string text =
          std::string(kind == MessageKind::trees ? "trees: " : "status: ") + error.what();
      if (named_.insert(text).second) spdlog::warn("{}", text);
    }
    std::fflush(stdout);
  }

  const StreamFigures& figures() const { return figures_; }

 private:
  template <typename Message, typename... File>
  void show(const Message& message, const File&... file) {
    if (!json_) return print(message);
    write_json_line(message, file..., line_);
    std::fputs(line_.c_str(), stdout);
  }

  bool json_;
  StreamFigures figures_;
  std::set<std::string> named_;
  std::string line_;
};

void listen(const ListenOptions& options) {
  const StopSignals stop;
  Listener listener(options.json);
  LcmSubscriber lcm(
      parse_lcm_url(options.lcm_url, "--lcm", ""),
      [&](MessageKind kind, std::span<const std::byte> bytes) { listener.receive(kind, bytes); });
  std::array<pollfd, 2> waits{pollfd{stop.fd(), POLLIN, 0}, pollfd{lcm.fd(), POLLIN, 0}};
  while (options.count == 0 || listener.figures().lists() < options.count) {
    if (::poll(waits.data(), waits.size(), -1) < 0) continue;
    if (waits[0].revents != 0) break;
    if (waits[1].revents != 0) lcm.handle();
  }
  std::printf("%s\n",
              (options.json ? listener.figures().json() : listener.figures().text()).c_str());
}

}  // namespace

void add_listen(CLI::App& app) {
  auto options = std::make_shared<ListenOptions>();
  CLI::App* command = app.add_subcommand("listen", "Shows the lists and states on a bus");
  command->add_option("--lcm", options->lcm_url, "LCM's address")->capture_default_str();
  command->add_option("--count", options->count, "Stop after so many lists; 0 = never")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--json", options->json, "A line of JSON a message, and one at the end");
  command->callback([options] { listen(*options); });
}

}  // namespace bole
