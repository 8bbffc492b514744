"""Every format at both sizes gives the lists that the same frames give in replay."""

from rig import environment, frames
from rig.appliance import Boled, Listener
from rig.camera import Camera
from rig.replay import NO_TRACKS, expect_same_trees, replayed_lists
from rig.wait import wait_until

SMOKE = True
TIME_LIMIT_S = 600


def run():
    fourccs = ("YUYV", "RGGB", "MJPG") if environment.is_smoke() else frames.USB_FORMATS
    sizes = frames.SIZES[:1] if environment.is_smoke() else frames.SIZES
    modes = [frames.rendered(fourcc, size) for fourcc in fourccs for size in sizes]
    with Listener() as listener:
        trees = sum(trees_of(mode, listener) for mode in modes)
    assert trees > 0, "no picture showed a tree, so that the lists say nothing"
    return f"{len(modes)} modes, {trees} trees"


def trees_of(mode, listener):
    size = (mode.width, mode.height)
    replayed = replayed_lists(mode.fourcc, size)
    lists = live_lists(mode, size, len(replayed), listener)
    return expect_same_trees(lists, replayed, mode)


def live_lists(mode, size, picture_count, listener):
    """Lists from the camera, at least one of each picture."""
    mark = listener.mark()

    def lists_of_all():
        lists = listener.lists(mark)
        seen = {one["sensor_seq"] % picture_count for one in lists}
        return lists if len(seen) == picture_count else None

    settings = [NO_TRACKS, f'source.format="{frames.PROJECT_NAMES[mode.fourcc]}"']
    with Camera([mode], rates=(5,)) as camera:
        camera.plug()
        with Boled(f"v4l2:{camera.link}", size, *settings) as boled:
            boled.wait_for_log("state streaming", 60)
            return wait_until(lists_of_all, 30, f"{mode}: a list of each picture")
