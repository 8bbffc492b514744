"""The rig itself: every format and size of the USB camera arrives bit for bit."""

from rig import environment, frames, v4l2
from rig.camera import Camera
from rig.wait import expect

SMOKE = True
TIME_LIMIT_S = 120


def run():
    sizes = frames.SIZES[:1] if environment.is_smoke() else frames.SIZES
    modes = [frames.noise(fourcc, size) for fourcc in frames.USB_FORMATS for size in sizes]
    with Camera(modes, rates=(15,)) as camera:
        camera.plug()
        for mode in modes:
            expect_bit_exact(mode, v4l2.record(camera.device, mode, 6))


def expect_bit_exact(mode, recorded):
    """Each frame must be one of the source's; on a slow machine the driver may leave some out."""
    source = mode.frames()
    expect(sum(frame not in source for frame in recorded), 0, f"frames that are not of {mode}")
