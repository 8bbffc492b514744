#include "service/processor.h"

#include <map>

#include <gtest/gtest.h>

#include "capture/replay/replay_source.h"
#include "publish/decoder.h"
#include "simulate/recording.h"
#include "support/temporary_folder.h"
#include "warp/camera_files.h"

namespace bole {
namespace {

using namespace std::chrono_literals;

/// The ids in each frame's list, by the frame's count.
using Ids = std::map<std::int64_t, std::vector<std::int32_t>>;

Ids ids_at(std::string_view pace, const std::filesystem::path& drive, const Camera& camera,
           const WarpTable& table) {
  ReplayClock clock;  // in which no frame is late, however slow this machine is
  ReplayOptions replay;
  replay.path = drive;
  replay.size = camera.model->image_size();
  replay.pace = parse_replay_pace(pace);
  const auto source = make_replay_source(replay, clock);
  Processor processor(table, camera.config.mount.height, camera.config.search, {}, clock);
  Ids ids;
  source->open();
  for (Grab grab = source->grab(1h); grab.kind == Grab::Kind::frame; grab = source->grab(1h)) {
    const tree_list_t list = decode_tree_list(processor.process(grab.frame).bytes);
    for (const tree_t& tree : list.trees) ids[list.sensor_seq].push_back(tree.id);
  }
  return ids;
}

TEST(Processor, TracksAlikeAtWhateverPaceARecordingIsReplayed) {
  const test::TemporaryFolder drive;
  const Camera camera = load_camera(BOLE_SOURCE_DIR "/tests/hil/cameras/640x480/camera.toml");
  simulate::RecordingOptions recording;
  recording.frames = 8;
  recording.seed = 7;
  recording.format = "grey";
  recording.world = simulate::preset("drive");
  simulate::record(drive.path(), camera, recording, [](int) {});
  const WarpTable table = build_warp_table(camera);

  const Ids lockstep = ids_at("lockstep", drive.path(), camera, table);
  ASSERT_GE(lockstep.size(), 7U) << "no trees to follow";
  EXPECT_EQ(ids_at("fast", drive.path(), camera, table), lockstep);
  EXPECT_EQ(ids_at("rate:30", drive.path(), camera, table), lockstep);
}

}  // namespace
}  // namespace bole
