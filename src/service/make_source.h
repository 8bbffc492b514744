#pragma once

#include <memory>

#include "base/clock.h"
#include "capture/frame_source.h"
#include "publish/tree_list.h"
#include "service/daemon_config.h"
#include "warp/camera_files.h"

namespace bole {

/// Where frames come from, the clock that goes with it, and how the pipeline has to treat it. The
/// clock stands before the source, which uses it to its end.
struct SourceSetup {
  std::unique_ptr<Clock> clock;
  std::unique_ptr<FrameSource> source;
  ListSource kind = ListSource::replay;
  bool lockstep = false;
};

/// The source that `config.source` names. Throws ConfigError when there is no such source or its
/// options do not fit; a camera that is merely not there is none of that.
SourceSetup make_source(const DaemonConfig& config, const Camera& camera);

}  // namespace bole
