#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/clock.h"
#include "capture/frame_source.h"

namespace bole {

/// One thing that goes wrong with a camera.
struct Fault {
  enum class Kind {
    drop,        ///< `count` frames never come
    duplicate,   ///< a frame comes again, `count` times
    stall,       ///< for `duration_s` nothing comes
    corrupt,     ///< `count` frames come marked as faulty
    unplug,      ///< the camera is gone for `duration_s`
    late,        ///< `count` frames come `duration_s` after their time
    clock_step,  ///< from here on the stamps of a replay are `step_s` off
  };
  Kind kind = Kind::drop;
  std::optional<std::int64_t> frame;  ///< begins at this count of the sensor ...
  double at_s = 0;                    ///< ... or so many seconds after the first frame's stamp
  int count = 1;
  double duration_s = 0;
  double step_s = 0;
};

/// Reads a script: `[[fault]]` tables with `kind`, `frame` or `at_s`, and what the kind needs
/// (`count`, `duration_s`, `step_s`). Throws ConfigError.
std::vector<Fault> read_faults(const std::filesystem::path& path);

/// `inner` with faults. Durations go by `clock`, so they hold in lockstep as in real time; with
/// `fast` no time passes in which frames could be missed. `clock` must outlive the source.
std::unique_ptr<FrameSource> make_faulty_source(std::unique_ptr<FrameSource> inner,
                                                const std::vector<Fault>& faults, Clock& clock);

}  // namespace bole
