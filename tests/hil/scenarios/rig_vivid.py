"""The rig itself: vivid plays frames of ours back, single- and multi-planar, bit for bit."""

from rig import frames, v4l2, vivid
from rig.wait import expect

SMOKE = False
TIME_LIMIT_S = 180


def run():
    for multiplanar, fourcc in ((False, "RGB3"), (False, "BGR3"), (True, "NV12"), (True, "NM12")):
        mode = frames.noise(fourcc, (640, 480))
        with vivid.Loop(mode, multiplanar) as loop:
            source = mode.frames()
            recorded = v4l2.record(loop.device, mode, 4)
            # The two ends run freely: frames repeat or are left out, but each is one of ours.
            unknown = sum(frame not in source for frame in recorded)
            expect(unknown, 0, f"{fourcc} frames that are not ours")
