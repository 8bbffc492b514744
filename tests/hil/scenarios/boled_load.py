"""Both cores busy for a minute: the newest frame wins, and every frame is accounted for."""

import contextlib
import time

from rig import frames
from rig.appliance import Boled, Listener, drops
from rig.camera import Camera
from rig.process import Process
from rig.wait import expect, wait_until

SMOKE = False
TIME_LIMIT_S = 180
SIZE = (640, 480)
BUSY_S = 60


def run():
    with contextlib.ExitStack() as stack:
        camera = stack.enter_context(Camera([frames.rendered("YUYV", SIZE)], rates=(30,)))
        listener = stack.enter_context(Listener())
        camera.plug()
        stack.enter_context(Boled(f"v4l2:{camera.link}", SIZE))
        listener.wait_for_list(60)
        for core in range(2):
            stack.enter_context(Process(f"burner{core}", ["sh", "-c", "while :; do :; done"]))
        time.sleep(BUSY_S)
        mark = listener.mark()
        camera.command("freeze")
        listener.wait_for_state("stalled", 20, mark)
        status = wait_until(lambda: settled_status(listener), 20, "the last frame's list")
        return account(listener.lists(), status)


def settled_status(listener):
    """The last status, once nothing is on its way from the camera to the bus any more."""
    status = listener.last_status()
    processed = status["lists"] + drops(status)["overwritten"] + drops(status)["unusable"]
    arrived = listener.lists()[-1]["seq"] + 1
    return status if processed == status["frames"] and arrived == status["lists"] else None


def account(lists, status):
    """Lists and drops together are the frames that the driver counted, up to the newest."""
    counted = drops(status)
    frames_of_driver = lists[-1]["sensor_seq"] + 1
    expect(status["lists"] + sum(counted.values()), frames_of_driver,
           f"lists and drops {counted} against the driver's count")
    latencies_s = sorted((one["publish_mono_ns"] - one["capture_mono_ns"]) / 1e9 for one in lists)
    published_s = [one["publish_mono_ns"] / 1e9 for one in lists]
    longest_s = max(later - earlier for earlier, later in zip(published_s, published_s[1:]))
    # The newest frame waits for the one in processing, and is then processed itself; older ones
    # would have queued.
    assert latencies_s[-1] <= 2 * longest_s, (
        f"a list came {latencies_s[-1]:.2f} s after its frame, at most {longest_s:.2f} s apart")
    return (f"{frames_of_driver} frames, {status['lists']} lists, drops {counted}, latency median "
            f"{latencies_s[len(latencies_s) // 2] * 1e3:.0f} ms, max {latencies_s[-1] * 1e3:.0f} ms")
