"""libcamera through its real uvcvideo handler: the same lists as in replay, unplug and replug."""

import time

from rig import frames
from rig.appliance import Boled, Listener
from rig.camera import Camera
from rig.libcamera import camera_id, provide_firmware_node
from rig.replay import NO_TRACKS, expect_same_trees, replayed_lists

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
            plugged = time.monotonic()
            mark = listener.mark()
            camera.plug()
            back, _ = listener.wait_for_list(30, mark)
            listener.wait_for_lists(len(replayed), 30, mark)
        trees = expect_same_trees(listener.lists(), replayed, "libcamera")
    assert trees > 0, "no picture showed a tree, so that the lists say nothing"
    return (f"no camera seen within {outage_seen - unplugged:.2f} s, a list again within "
            f"{back - plugged:.2f} s")
