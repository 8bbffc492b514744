"""libcamera through its real uvcvideo handler: the same lists as in replay, unplug and replug."""

import time

from rig import frames
from rig.appliance import Boled, Listener
from rig.camera import Camera
from rig.libcamera import camera_id, provide_firmware_node
from rig.replay import NO_TRACKS, replayed_lists
from rig.wait import expect

SMOKE = True
TIME_LIMIT_S = 180
SIZE = (640, 480)


def run():
    provide_firmware_node()
    replayed = replayed_lists("YUYV", SIZE)
    mode = frames.rendered("YUYV", SIZE)
    with Camera([mode], rates=(10,)) as camera, Listener() as listener:
        camera.plug()
        with Boled(f"libcamera:{camera_id(camera)}", SIZE, NO_TRACKS):
            listener.wait_for_lists(len(replayed), 60)
            unplugged = time.monotonic()
            mark = listener.mark()
            camera.unplug()
            outage_seen, _ = listener.wait_for_state("no camera", 10, mark)
            camera.plug()
            there = time.monotonic()
            back, _ = listener.wait_for_new_list(30)
        expect_pictures(listener.lists(), replayed)
    return (f"no camera seen within {outage_seen - unplugged:.2f} s, a list again within "
            f"{back - there:.2f} s")


def expect_pictures(lists, replayed):
    """Each list must be one of the replayed ones, and each of those must have come. libcamera counts
    frames from the first that it gets, so its count does not tell which picture a list is of."""
    known = [one["trees"] for one in replayed]
    assert any(known), "no picture showed a tree, so that the lists say nothing"
    pictures = {known.index(one["trees"]) if one["trees"] in known else "unknown" for one in lists}
    expect(pictures, set(range(len(known))), "pictures that the lists are of")
