"""A camera that takes its time over each setting: the service waits for it, however long all of
them take together. One that does not answer at all is told as such."""

import boled_service as service
from rig import frames
from rig.appliance import Listener
from rig.camera import Camera
from rig.wait import expect

SMOKE = False
TIME_LIMIT_S = 240
SIZE = (640, 480)
SETTINGS = """exposure = "fixed"
gain = 20
white_balance = "fixed"
power_line = "50 Hz"
"""


def run():
    service.install()
    with Camera([frames.rendered("YUYV", SIZE)], rates=(10,)) as camera, Listener() as listener:
        service.configure(camera, SETTINGS)
        camera.plug()
        camera.command("hesitate 1500")
        try:
            opened = service.timed(lambda: service.systemctl("start", "boled"))
            listener.wait_for_list(60)
            expect(service.show("NRestarts"), "0", "restarts of the service")
            watchdog_s = int(service.show("WatchdogUSec").removesuffix("s"))
            assert opened > watchdog_s, f"opened in {opened:.1f} s: not slow enough to tell"

            # What stalls is closed and opened again.
            camera.command("hesitate 0")
            camera.command("mute")
            mark = listener.mark()
            camera.command("freeze")
            listener.wait_for_status(lambda status: "does not answer" in status["state_reason"],
                                     60, "a camera that does not answer", mark)
            camera.command("answer")
            camera.command("run")
            listener.wait_for_new_list(60)
            expect(service.show("NRestarts"), "0", "restarts of the service")
        finally:
            service.systemctl("stop", "boled")
            service.keep_journal()
    return f"opened within {opened:.1f} s"
