"""No device at boot, and a device that boled may not open: both are waited for."""

import os

from rig import frames
from rig.appliance import Boled, Listener, camera_events
from rig.camera import Camera
from rig.wait import expect

SMOKE = False
TIME_LIMIT_S = 120
SIZE = (640, 480)
AS_NOBODY = ("setpriv", "--reuid=65534", "--regid=65534", "--clear-groups", "--no-new-privs")


def run():
    mode = frames.rendered("YUYV", SIZE)
    with Camera([mode]) as camera, Listener() as listener:
        with Boled(f"v4l2:{camera.link}", SIZE) as boled:
            listener.wait_for_state("no camera", 60)
            camera.plug()
            listener.wait_for_new_list(20)
            expect(len(boled.log_lines("no camera")), 1, "log lines about the missing camera")
            assert camera_events(listener.last_status())["failed_opens"] > 0, "no try was counted"
        os.chmod(camera.device, 0o600)
        mark = listener.mark()
        with Boled(f"v4l2:{camera.link}", SIZE, wrapper=AS_NOBODY, name="boled_as_nobody") as boled:
            listener.wait_for_status(lambda status: "ermission" in status["state_reason"], 60,
                                     "permission denied", mark)
            os.chmod(camera.device, 0o666)
            listener.wait_for_new_list(20)
            expect(len(boled.log_lines("ermission")), 1, "log lines about the permission")
