"""libcamera through its real uvcvideo handler: the same lists as in replay, unplug and replug."""

from rig import environment, frames
from rig.appliance import Boled, Listener, camera_events, replug
from rig.camera import Camera
from rig.libcamera import camera_id, provide_firmware_node
from rig.replay import NO_TRACKS, replayed_lists
from rig.wait import expect, wait_until

SMOKE = True
TIME_LIMIT_S = 300
SIZE = (640, 480)
OUTAGE_SEEN_WITHIN_S = 0.5


def run():
    rounds = 1 if environment.is_smoke() else 20
    provide_firmware_node()
    replayed = replayed_lists("YUYV", SIZE)
    seen, again = [], []
    with Camera([frames.rendered("YUYV", SIZE)], rates=(10,)) as camera, Listener() as listener:
        camera.plug()
        with Boled(f"libcamera:{camera_id(camera)}", SIZE, NO_TRACKS) as boled:
            wait_until(lambda: len(pictures(listener.lists(), replayed)) == len(replayed), 60,
                       "a list of each picture")
            replug(camera, listener)  # the first outage may load what later ones have
            holdings = boled.holdings()
            for _ in range(rounds):
                outage_s, back_s = replug(camera, listener)
                seen.append(outage_s)
                again.append(back_s)
            wait_until(lambda: boled.holdings() == holdings, 10,
                       f"boled holds {holdings} again, as after the first outage")
            expect(camera_events(listener.last_status())["losses"], 1 + rounds, "losses counted")
            # libcamera ends a program that stops a camera whose loss it has not heard of yet.
            camera.command("unplug")
            expect(boled.end(), 0, "boled's exit status in an outage")
    expect(pictures(listener.lists(), replayed), set(range(len(replayed))), "pictures of the lists")
    assert max(seen) <= OUTAGE_SEEN_WITHIN_S, f"outage seen after {max(seen):.2f} s"
    return (f"{rounds} times; no camera seen within {max(seen):.2f} s, "
            f"a list again within {max(again):.2f} s")


def pictures(lists, replayed):
    """Which pictures the lists are of. libcamera counts frames from the first that it gets, so that
    only the trees tell; "unknown" are those of no picture."""
    known = [one["trees"] for one in replayed]
    assert any(known), "no picture showed a tree, so that the lists say nothing"
    return {known.index(one["trees"]) if one["trees"] in known else "unknown" for one in lists}
