"""The rig itself: the USB camera misbehaves as it is told, and the kernel shows it."""

import subprocess

from rig import frames, v4l2
from rig.camera import Camera
from rig.wait import expect

SMOKE = True
TIME_LIMIT_S = 90
MODE_SIZE = (640, 480)


def run():
    mode = frames.noise("YUYV", MODE_SIZE)
    with Camera([mode]) as camera:
        camera.plug()
        v4l2.set_format(camera.device, mode)
        bad_frames_leave_gaps(camera)
        frozen_then_running(camera)
        refused_control(camera)
        new_number_after_replug(camera)
    other_camera_of_the_same_name()


def bad_frames_leave_gaps(camera):
    """uvcvideo drops frames that are short or marked as bad; their numbers are missing."""
    for fault in ("shorten 1", "mark 1"):
        with v4l2.Stream(camera.device) as stream:
            stream.wait_for_frames(3)
            camera.command(fault)
            stream.wait_for_frames(6)
            sequences = stream.sequences()
        expect(sequences[-1] - sequences[0] - len(sequences) + 1, 1, f"frames lost by {fault}")


def frozen_then_running(camera):
    with v4l2.Stream(camera.device) as stream:
        stream.wait_for_frames(3)
        camera.command("freeze")
        stream.stderr.wait_for(lambda line: "timeout" in line, 10, "v4l2-ctl gives up")
    camera.command("step 5")
    expect(len(v4l2.record(camera.device, frames.noise("YUYV", MODE_SIZE), 5)), 5, "steps")
    camera.command("run")


def refused_control(camera):
    v4l2.control_tool(camera.device, "-c", "gain=20")
    camera.wait_for_event("control", 5, name="gain", value=20)
    camera.command("refuse gain")
    try:
        v4l2.control_tool(camera.device, "-c", "gain=21")
        raise AssertionError("a refused control was set")
    except subprocess.CalledProcessError:
        camera.wait_for_event("control_refused", 5, name="gain", value=21)


def new_number_after_replug(camera):
    """An open descriptor keeps the number of a device that is gone, so the next one gets another.
    Streaming ends with the device."""
    before = camera.device
    with open(before), v4l2.Stream(before) as stream:
        stream.wait_for_frames(3)
        camera.unplug()
        stream.wait(10)
        camera.plug()
        assert camera.device != before, f"still {before}"


def other_camera_of_the_same_name():
    """It comes back with another format and size."""
    mode = frames.noise("GREY", (1280, 720))
    with Camera([mode]) as camera:
        camera.plug()
        expect(v4l2.record(camera.device, mode, 1), mode.frames()[:1], "the other camera's frame")
