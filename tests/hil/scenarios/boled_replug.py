"""Unplugged and replugged in mid-stream, its device number changing: boled streams again."""

from rig import environment, frames
from rig.appliance import Boled, Listener, camera_events, replug
from rig.camera import Camera
from rig.wait import expect, wait_until

SMOKE = True
TIME_LIMIT_S = 300
SIZE = (640, 480)
OUTAGE_SEEN_WITHIN_S = 0.5
STREAMS_AGAIN_WITHIN_S = 2.0


def run():
    rounds = 3 if environment.is_smoke() else 20
    mode = frames.rendered("YUYV", SIZE)
    seen, again, devices = [], [], set()
    with Camera([mode], rates=(10,)) as camera, Listener() as listener:
        camera.plug()
        with Boled(f"v4l2:{camera.link}", SIZE) as boled:
            listener.wait_for_list(60)
            replug_elsewhere(camera, listener)  # the first outage may load what later ones have
            holdings = boled.holdings()
            for _ in range(rounds):
                outage_s, back_s = replug_elsewhere(camera, listener)
                seen.append(outage_s)
                again.append(back_s)
                devices.add(camera.device)
            # A frame in processing holds the buffers of its stream a moment longer.
            wait_until(lambda: boled.holdings() == holdings, 10,
                       f"boled holds {holdings} again, as after the first outage")
            expect(camera_events(listener.last_status())["losses"], 1 + rounds, "losses counted")
    assert len(devices) > 1, f"the device was always {devices}"
    assert max(seen) <= OUTAGE_SEEN_WITHIN_S, f"outage seen after {max(seen):.2f} s"
    assert max(again) <= STREAMS_AGAIN_WITHIN_S, f"streaming again after {max(again):.2f} s"
    return (f"{rounds} times; no camera seen within {max(seen):.2f} s, "
            f"a list again within {max(again):.2f} s")


def replug_elsewhere(camera, listener):
    """The same, the camera coming back under another number. That it is there again takes the kernel
    and udev a second or more in emulation."""
    with open(camera.device):  # keeps its number
        return replug(camera, listener)
