"""bolectl grab: in every format a frame comes out bit for bit as the camera sent it."""

import itertools
import subprocess

from rig import environment, frames
from rig.appliance import camera_file
from rig.camera import Camera

SMOKE = False
TIME_LIMIT_S = 240


def run():
    # No picture comes out of the decoder of random JPEGs.
    sizes = itertools.cycle(frames.SIZES)
    modes = [frames.rendered(fourcc, size) if fourcc == "MJPG" else frames.noise(fourcc, size)
             for fourcc, size in zip(frames.USB_FORMATS, sizes)]
    with Camera(modes) as camera:
        camera.plug()
        for mode in modes:
            assert grab(camera, mode) in mode.frames(), f"{mode}: not a frame that the camera sent"
    return f"{len(modes)} modes"


def grab(camera, mode):
    """The bytes of a frame grabbed in this mode."""
    bolectl = environment.build("firmware_app/bolectl")
    report = subprocess.run(
        [bolectl, "grab", "--camera", camera_file((mode.width, mode.height)),
         "--source", f"v4l2:{camera.link}", "--out", environment.SCRATCH / "grabbed",
         "--set", f'source.format="{frames.PROJECT_NAMES[mode.fourcc]}"'],
        check=True, capture_output=True, text=True, timeout=60).stdout
    _, file = report.splitlines()
    with open(file, "rb") as image:
        return image.read()
