"""A camera that freezes is a state of its own, and is left when it thaws."""

import time

from rig import frames
from rig.appliance import Boled, Listener, camera_events
from rig.camera import Camera
from rig.wait import expect

SMOKE = True
TIME_LIMIT_S = 120
SIZE = (640, 480)


def run():
    with Camera([frames.rendered("GREY", SIZE)], rates=(10,)) as camera, Listener() as listener:
        camera.plug()
        with Boled(f"v4l2:{camera.link}", SIZE, 'source.format="grey"') as boled:
            listener.wait_for_list(60)
            mark = listener.mark()
            frozen = time.monotonic()
            camera.command("freeze")
            seen, status = listener.wait_for_state("stalled", 10, mark)
            assert status["state_reason"], "no reason given"
            # Closing and opening a stalled camera may bring it back: it must have been tried.
            camera.wait_for_event("stopped", 10)
            mark = listener.mark()
            camera.command("run")
            listener.wait_for_new_list(20)
            listener.wait_for_state("streaming", 5, mark)
            expect(len(boled.log_lines("stalled")), 1, "log lines about it")
            events = camera_events(listener.last_status())
            expect((events["stalls"], events["restarts"] > 0), (1, True), f"counted in {events}")
    return f"seen within {seen - frozen:.2f} s"
