"""bolectl cameras: what is there, under names that outlast a replug."""

import json
import subprocess

from rig import environment, frames
from rig.appliance import Boled, Listener
from rig.camera import Camera
from rig.libcamera import camera_id, provide_firmware_node
from rig.wait import expect, wait_until

SMOKE = False
TIME_LIMIT_S = 120
SIZE = (640, 480)


def run():
    provide_firmware_node()
    expect(cameras("--json"), "[]\n", "cameras while there is none")
    expect(cameras(), "no camera is there\n", "the same for people")
    modes = [frames.rendered("YUYV", SIZE), frames.noise("GREY", (1280, 720))]
    with Camera(modes, serial="LEFT", port=0) as left, Camera(modes, serial="RIGHT", port=1) as right:
        left.plug()
        right.plug()
        before = wait_until(lambda: names_with_libcamera(left), 20, "libcamera lists a camera")
        expect_whole(before, left)
        devices = left.device, right.device
        with open(left.device), open(right.device):  # keep their numbers
            left.unplug()
            right.unplug()
            expect(names(), {}, "cameras when both are pulled out")
            right.plug()  # in the other order
            left.plug()
        assert (left.device, right.device) != devices, f"still {devices}"
        after = wait_until(lambda: names_with_libcamera(left), 20, "libcamera lists a camera")
        expect(after.keys(), before.keys(), "names after a replug")
        # A name that is listed is one that boled takes.
        with Boled(f"v4l2:{left.link}", SIZE), Listener() as listener:
            listener.wait_for_list(60)


def names():
    """The cameras by the name to use for each."""
    return {one["source"]: one for one in json.loads(cameras("--json"))}


def names_with_libcamera(camera):
    """The same, once libcamera lists this one."""
    found = names()
    return found if f"libcamera:{camera_id(camera)}" in found else None


def expect_whole(found, left):
    """Names, formats, sizes, rates and controls of the first camera, for programs and for people."""
    camera = found[f"v4l2:{left.link}"]
    expect((camera["driver"], "LEFT" in camera["other_names"]), ("uvcvideo", True), "driver, serial")
    modes = {(one["format"], one["readable_as"], one["width"], one["height"], *one["rates_hz"])
             for one in camera["modes"]}
    rates = (10, 30, 15, 5)
    expect(modes, {("YUYV", "yuyv", 640, 480, *rates), ("GREY", "grey", 1280, 720, *rates)}, "modes")
    gain = next(one for one in camera["controls"] if one["name"] == "Gain")
    assert gain["min"] <= gain["default"] <= gain["max"], gain
    text = cameras()
    for part in (f"v4l2:{left.link}", "YUYV 640 x 480 at 10, 30, 15, 5 Hz", "Gain = "):
        assert part in text, f"no {part} in:\n{text}"


def cameras(*options):
    return subprocess.run([environment.build("firmware_app/bolectl"), "cameras", *options],
                          check=True, capture_output=True, text=True, timeout=60).stdout
