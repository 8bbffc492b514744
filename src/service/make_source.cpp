#include "service/make_source.h"

#include <string_view>
#include <utility>

#include "base/errors.h"
#include "capture/libcamera/libcamera.h"
#include "capture/replay/faults.h"
#include "capture/replay/replay_source.h"
#include "capture/v4l2/v4l2_source.h"

namespace bole {
namespace {

SourceSetup make_replay(const DaemonConfig& config, const std::string& path, const Camera& camera) {
  const DaemonConfig::SourcePart& part = config.source;
  ReplayOptions options;
  options.origin = config.file;
  options.path = path;
  options.size = camera.model->image_size();
  options.mask = mask_file(camera);
  options.pace = parse_replay_pace(part.pace, config.file);
  options.loop = part.loop;
  options.start_s = part.start;
  options.end_s = part.end;
  options.restamp = part.restamp;
  options.rate_hz = part.rate;

  SourceSetup setup;
  setup.lockstep = options.pace.kind == ReplayPace::Kind::lockstep;
  if (setup.lockstep) {
    setup.clock = std::make_unique<ReplayClock>();
  } else {
    setup.clock = std::make_unique<SystemClock>();
  }
  setup.source = make_replay_source(options, *setup.clock);
  if (!part.faults.empty()) {
    setup.source =
        make_faulty_source(std::move(setup.source), read_faults(part.faults), *setup.clock);
  }
  return setup;
}

void refuse_replay_settings(const DaemonConfig& config) {
  const DaemonConfig::SourcePart& set = config.source;
  const DaemonConfig::SourcePart usual;
  for (const auto& [key, differs] :
       {std::pair{"pace", set.pace != usual.pace}, std::pair{"loop", set.loop},
        std::pair{"restamp", set.restamp}, std::pair{"start_s", set.start != usual.start},
        std::pair{"end_s", set.end != usual.end}, std::pair{"rate_hz", set.rate != usual.rate},
        std::pair{"faults", !set.faults.empty()}}) {
    if (!differs) continue;
    throw ConfigError(config.file, std::string("source.") + key,
                      "is only for a replay, but the source is " + set.uri, "leave it out");
  }
}

// `make`: make_v4l2_source or make_libcamera_source.
template <class Make>
SourceSetup make_camera(const DaemonConfig& config, const std::string& name, const Camera& camera,
                        ListSource kind, Make make) {
  refuse_replay_settings(config);
  CameraSettings settings = config.source.camera;
  settings.size = camera.model->image_size();
  SourceSetup setup;
  setup.kind = kind;
  setup.clock = std::make_unique<SystemClock>();
  setup.source = make(name, settings, *setup.clock);
  return setup;
}

}  // namespace

SourceSetup make_source(const DaemonConfig& config, const Camera& camera) {
  const std::string& uri = config.source.uri;
  const std::size_t colon = uri.find(':');
  const std::string scheme = uri.substr(0, colon);
  const std::string rest = colon == std::string::npos ? "" : uri.substr(colon + 1);
  if (scheme == "replay" && !rest.empty()) return make_replay(config, rest, camera);
  if (scheme == "v4l2" && !rest.empty()) {
    return make_camera(config, rest, camera, ListSource::v4l2, make_v4l2_source);
  }
  if (scheme == "libcamera" && !rest.empty()) {
    return make_camera(config, rest, camera, ListSource::libcamera, make_libcamera_source);
  }
  throw ConfigError(config.file, "source.uri", uri.empty() ? "is missing" : "is \"" + uri + "\"",
                    "must be v4l2:DEVICE, libcamera:ID or replay:PATH");
}

}  // namespace bole
