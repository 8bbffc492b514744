"""Every format at both sizes gives the lists that the same frames give in replay."""

from rig import environment, frames
from rig.appliance import Boled, Listener
from rig.camera import Camera
from rig.replay import NO_TRACKS, expect_same_trees, replayed_lists
from rig.wait import expect

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
    expect([one["sensor_seq"] for one in lists], list(range(len(lists))), f"{mode}: sensor_seq")
    return expect_same_trees(lists, replayed, mode)


def live_lists(mode, size, count, listener):
    """The lists of each picture once. The camera shows the next when the last has been seen, so
    that none is dropped, however slow the machine."""
    with Camera([mode]) as camera:
        camera.command("freeze")
        camera.plug()
        mark = listener.mark()
        settings = [NO_TRACKS, f'source.format="{frames.PROJECT_NAMES[mode.fourcc]}"']
        with Boled(f"v4l2:{camera.link}", size, *settings) as boled:
            boled.wait_for_log("waiting for the first frame", 60)
            listener.wait_for_state("opening", 10, mark)  # so it listens
            lists = []
            for _ in range(count):
                mark = listener.mark()
                camera.command("step 1")
                lists.append(listener.wait_for_list(mark=mark)[1])
    return lists
