"""The rig itself: every format and size of the USB camera arrives bit for bit."""

from rig import frames, v4l2
from rig.camera import Camera
from rig.wait import expect

SMOKE = True
TIME_LIMIT_S = 120


def run():
    modes = [frames.noise(fourcc, size) for fourcc in frames.USB_FORMATS for size in frames.SIZES]
    with Camera(modes) as camera:
        camera.plug()
        for mode in modes:
            expect_bit_exact(mode, v4l2.record(camera.device, mode, 6))


def expect_bit_exact(mode, recorded):
    """The recording must be the source's frames, from the first on, in their order."""
    source = mode.frames()
    shown = [source.index(frame) if frame in source else "unknown" for frame in recorded]
    expect(shown, [i % len(source) for i in range(len(recorded))], f"frames of {mode}")
