"""Short, damaged and undecodable frames are counted by cause, named once, and change nothing else."""

import pathlib

from rig import frames
from rig.appliance import Boled, Listener, drops
from rig.camera import Camera
from rig.wait import expect

SMOKE = False
TIME_LIMIT_S = 180
SIZE = (640, 480)
# Whether uvcvideo hands on what it knows to be damaged; read when a camera is plugged in.
NODROP = pathlib.Path("/sys/module/uvcvideo/parameters/nodrop")


def run():
    # The driver's default: it keeps damaged frames to itself, and only its count tells.
    cause_is("shorten 2", "YUYV", "missing")
    cause_is("mark 2", "YUYV", "missing")
    NODROP.write_text("1")
    try:
        cause_is("shorten 2", "YUYV", "damaged")
        cause_is("mark 2", "YUYV", "damaged")
    finally:
        NODROP.write_text("0")
    # No driver knows how long a JPEG must be.
    cause_is("shorten 2", "MJPG", "unusable")


def cause_is(fault, fourcc, cause):
    mode = frames.rendered(fourcc, SIZE)
    with Camera([mode], rates=(5,)) as camera, Listener() as listener:
        camera.plug()
        settings = [f'source.format="{frames.PROJECT_NAMES[fourcc]}"']
        with Boled(f"v4l2:{camera.link}", SIZE, *settings) as boled:
            listener.wait_for_list(60)
            listener.wait_for_state("streaming", 10)
            before = drops(listener.last_status())
            mark = listener.mark()
            camera.command(fault)
            try:
                _, status = listener.wait_for_status(
                    lambda status: drops(status)[cause] - before[cause] >= 2, 15,
                    f"{fault}: two more frames {cause}", mark)
            except TimeoutError as error:
                raise AssertionError(f"{error}; drops {drops(listener.last_status())}") from None
            listener.wait_for_new_list(20)
            expect(boled.child.poll(), None, "boled's exit status")
