#include "service/daemon.h"

#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <cerrno>
#include <optional>
#include <stdexcept>

#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

#include "base/clock.h"
#include "base/errors.h"
#include "base/stop_signals.h"
#include "service/make_publishers.h"
#include "service/make_source.h"
#include "service/pipeline.h"
#include "warp/table_cache.h"

namespace bole {
namespace {

CachedTable open_table(const DaemonConfig::CameraPart& part, const Camera& camera) {
  if (!part.table.empty())
    return {WarpTable::load(part.table, camera.digest), false, "", part.table};
  CachedTable cached = load_or_build_warp_table(
      camera, part.cache_directory.empty() ? default_cache_directory() : part.cache_directory);
  if (cached.built) spdlog::info("built the warp table");
  if (!cached.trouble.empty()) spdlog::warn("the warp table is not kept: {}", cached.trouble);
  return cached;
}

void lock_memory() {
  if (::mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
    spdlog::warn("service.lock_memory: {}; grant CAP_IPC_LOCK or raise LimitMEMLOCK",
                 error_text(errno));
  }
}

// Of this thread and of all that it starts, those within zenoh and libcamera included.
void set_realtime_priority(int priority) {
  const sched_param parameters{priority};
  if (::sched_setscheduler(0, SCHED_FIFO, &parameters) != 0) {
    spdlog::warn("service.realtime_priority: {}; grant CAP_SYS_NICE or raise LimitRTPRIO",
                 error_text(errno));
  }
}

std::string calibration_json(const Camera& camera) {
  const nlohmann::json calibration{{"camera.toml", camera.config_text},
                                   {"calibration", camera.calibration_text}};
  return calibration.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

double cpu_seconds() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

// A replay in lockstep promises its files every list. A network that is away is only a state.
void refuse_losses(const std::vector<bus_t>& buses) {
  for (const bus_t& bus : buses) {
    if (bus.name != "jsonl" || bus.failed == 0) continue;
    throw std::runtime_error(std::to_string(bus.failed) + " lists are lost: jsonl " +
                             bus.last_error);
  }
}

void log_start(const DaemonConfig& config, const std::string& version, const CachedTable& table) {
  std::string buses;
  for (const PublishTarget& target : config.publish.to) {
    buses += (buses.empty() ? "" : ", ") + address(target, config);
  }
  spdlog::info("bole {}: configuration {}; camera {} of {}; table {}; publishes to {}", version,
               config.file, config.camera.name, config.camera.file.string(),
               table.trouble.empty() ? table.path.string() : "in memory only", buses);
}

void log_summary(const Telemetry::Summary& summary, const std::vector<bus_t>& buses,
                 double elapsed) {
  const auto ms = [](std::int64_t ns) { return static_cast<double>(ns) / 1e6; };
  std::string drops;
  for (const counter_t& drop : summary.drops) {
    if (drop.count > 0) drops += " " + drop.name + " " + std::to_string(drop.count);
  }
  spdlog::info("replay: {} frames, {} lists, drops:{}", summary.frames, summary.lists,
               drops.empty() ? " none" : drops);
  spdlog::info("latency p50 {:.2f} ms, p99 {:.2f} ms, max {:.2f} ms; CPU {:.2f} s in {:.2f} s",
               ms(summary.latency_p50_ns), ms(summary.latency_p99_ns), ms(summary.latency_max_ns),
               cpu_seconds(), elapsed);
  for (const bus_t& bus : buses) {
    spdlog::info("{}: {} published, {} overwritten, {} failed, hand-over p99 {:.0f} us", bus.name,
                 bus.published, bus.overwritten, bus.failed, bus.handover_p99_us);
  }
}

}  // namespace

void run_daemon(const DaemonConfig& config, const std::string& version) {
  const Camera camera = load_camera(config.camera.file);
  const CachedTable cached = open_table(config.camera, camera);
  // Nobody looks at them before the pipeline runs: not before the table, which may take long, but
  // before the first thread, which a video's decoder may start.
  const StopSignals stop;
  SourceSetup setup = make_source(config, camera);
  if (config.service.realtime_priority > 0) set_realtime_priority(config.service.realtime_priority);
  // In lockstep a file holds the same bytes after every run.
  using Earlier = JsonlPublisher::Earlier;
  std::vector<std::unique_ptr<Publisher>> publishers = make_publishers(
      config, calibration_json(camera), setup.lockstep ? Earlier::erased : Earlier::kept);

  ProcessorOptions options;
  options.mode = config.detect.mode;
  options.track = config.detect.track;
  options.min_score = config.publish.min_score;
  options.camera = config.camera.name;
  options.config_crc = config_crc(config, camera.digest);
  options.source = setup.kind;
  options.lockstep = setup.lockstep;
  Processor processor(cached.table, camera.config.mount.height, camera.config.search, options,
                      *setup.clock);
  Telemetry telemetry(version, config.camera.name);
  if (config.service.lock_memory) lock_memory();
  std::optional<Trace> trace;
  if (!config.service.trace.empty()) trace.emplace(config.service.trace);

  log_start(config, version, cached);
  const SystemClock clock;
  const std::int64_t start_ns = clock.mono_ns();
  Pipeline pipeline(*setup.source, *setup.clock, processor, telemetry, std::move(publishers),
                    setup.lockstep, trace ? &*trace : nullptr);
  pipeline.run(stop.fd());
  if (setup.kind == ListSource::replay) {
    log_summary(telemetry.summary(), pipeline.bus_health(),
                static_cast<double>(clock.mono_ns() - start_ns) / 1e9);
  }
  if (setup.lockstep) refuse_losses(pipeline.bus_health());
}

}  // namespace bole
