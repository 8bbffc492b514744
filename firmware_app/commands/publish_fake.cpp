#include <poll.h>

#include <algorithm>
#include <memory>

#include "base/clock.h"
#include "base/stop_signals.h"
#include "commands/commands.h"
#include "daemon_options.h"
#include "publish/encoder.h"
#include "service/buses.h"
#include "service/make_publishers.h"
#include "service/telemetry.h"
#include "simulate/fake_wood.h"

namespace bole {
namespace {

struct Options {
  double rate_hz = 10;
  std::int64_t count = 0;
  std::uint64_t seed = 1;
};

// The buses of a daemon, fed with invented lists.
class FakeDaemon {
 public:
  FakeDaemon(const DaemonConfig& config, std::uint64_t seed)
      : wood_(seed),
        telemetry_(BOLE_VERSION, config.camera.name),
        buses_(make_publishers(config, "{}", JsonlPublisher::Earlier::kept), WhenFull::overwrite,
               [] {}) {
    list_.source = ListSource::fake;
    list_.camera = config.camera.name;
    telemetry_.capture_event({CameraState::streaming, "fake", false});
  }

  void publish_list(std::int64_t seq, double seconds) {
    list_.seq = list_.sensor_seq = seq;
    list_.utime = clock_.utc_us();
    list_.capture_mono_ns = clock_.mono_ns();
    list_.trees = wood_.trees(seconds);
    list_.publish_mono_ns = clock_.mono_ns();
    buses_.offer(MessageKind::trees, encoder_.encode(list_), "", list_.publish_mono_ns);
    telemetry_.processed(list_.publish_mono_ns - list_.capture_mono_ns, 0);
    CaptureCounts counts;
    counts.frames = seq + 1;
    telemetry_.capture_counts(counts);
  }

  // A bus that takes nothing is not waited for.
  void interrupt() { buses_.interrupt(); }

  void publish_status() { buses_.offer(telemetry_.status(clock_.mono_ns(), false), clock_); }

 private:
  SystemClock clock_;
  simulate::FakeWood wood_;
  Telemetry telemetry_;
  TreeListEncoder encoder_;
  TreeList list_;
  Buses buses_;
};

// True when it was told to stop before `deadline_ns`.
bool stopped_before(std::int64_t deadline_ns, const StopSignals& stop) {
  const std::int64_t wait_ns = std::max<std::int64_t>(deadline_ns - SystemClock().mono_ns(), 0);
  pollfd entry{stop.fd(), POLLIN, 0};
  return ::poll(&entry, 1, static_cast<int>(wait_ns / 1'000'000)) > 0;
}

void publish_fake(const DaemonConfig& config, const Options& options) {
  const StopSignals stop;
  FakeDaemon daemon(config, options.seed);
  const std::int64_t start_ns = SystemClock().mono_ns();
  std::int64_t next_status_ns = start_ns;
  for (std::int64_t seq = 0; options.count == 0 || seq < options.count; ++seq) {
    const double seconds = static_cast<double>(seq) / options.rate_hz;
    const std::int64_t due_ns = start_ns + static_cast<std::int64_t>(seconds * 1e9);
    if (stopped_before(due_ns, stop)) return daemon.interrupt();
    daemon.publish_list(seq, seconds);
    if (due_ns >= next_status_ns) {
      daemon.publish_status();
      next_status_ns += 1'000'000'000;
    }
  }
}

}  // namespace

void add_publish_fake(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "publish-fake", "Publishes lists of a simulated drive as boled would, without a camera");
  const auto daemon = add_daemon_options(*command);
  add_publish_option(*command, daemon);
  const auto options = std::make_shared<Options>();
  command->add_option("--rate", options->rate_hz, "Lists a second")
      ->type_name("HZ")
      ->capture_default_str()
      ->check(CLI::Range(0.1, 1000.0));
  command->add_option("--count", options->count, "Stop after so many lists; 0: never")
      ->type_name("LISTS")
      ->capture_default_str()
      ->check(CLI::Range(0, 1'000'000'000));
  command->add_option("--seed", options->seed, "Of the wood")
      ->type_name("NUMBER")
      ->capture_default_str();
  command->callback([daemon, options] { publish_fake(daemon->load(), *options); });
}

}  // namespace bole
