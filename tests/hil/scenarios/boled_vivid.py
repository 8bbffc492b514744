"""vivid: multi-planar formats, and those that the USB camera lacks, give the lists of replay."""

from rig import frames, vivid
from rig.appliance import Boled, Listener
from rig.replay import NO_TRACKS, expect_same_trees, replayed_lists

SMOKE = False
TIME_LIMIT_S = 240
SIZE = (640, 480)
# Whether with the multi-planar API. NM12, NV12 in two buffers, cannot be reached: where there is
# NV12 as well, boled takes that.
MODES = (("RGB3", False), ("NV12", False), ("YUYV", True), ("NV12", True), ("RGB3", True))


def run():
    trees = 0
    for fourcc, multiplanar in MODES:
        # One picture: vivid's two ends run freely, so its count does not tell pictures apart.
        replayed = replayed_lists(fourcc, SIZE)[:1]
        mode = frames.rendered(fourcc, SIZE, 1)
        with vivid.Loop(mode, multiplanar) as loop, Listener() as listener:
            settings = [NO_TRACKS, f'source.format="{frames.PROJECT_NAMES[fourcc]}"']
            with Boled(f"v4l2:{loop.device}", SIZE, *settings):
                listener.wait_for_lists(3, 60)
                # Before the player's first buffer the input shows a test picture.
                trees += expect_same_trees(listener.lists()[-1:], replayed, fourcc)
    assert trees > 0, "the picture showed no tree, so that the lists say nothing"
    return f"{len(MODES)} modes"
