"""A camera that comes back with another format or size, or refuses a control."""

from rig import frames
from rig.appliance import Boled, Listener, camera_events
from rig.camera import Camera
from rig.wait import expect

SMOKE = False
TIME_LIMIT_S = 240
SIZE = (640, 480)


def run():
    comes_back_different(frames.rendered("GREY", SIZE), usable=True)
    comes_back_different(frames.rendered("YUYV", (1280, 720)), usable=False)
    refuses_a_control()


def comes_back_different(other_mode, usable):
    """With any format that boled reads it goes on; a size that the calibration does not hold for is
    waited out."""
    first_mode = frames.rendered("YUYV", SIZE)
    with Listener() as listener:
        with Camera([first_mode]) as camera:
            camera.plug()
            boled = Boled(f"v4l2:{camera.link}", SIZE)
            listener.wait_for_list(60)
        with boled:
            listener.wait_for_state("no camera", 10)
            with Camera([other_mode]) as camera:
                mark = listener.mark()
                camera.plug()
                if usable:
                    listener.wait_for_new_list(20)
                else:
                    listener.wait_for_status(
                        lambda status: "calibration is for 640 x 480" in status["state_reason"], 20,
                        "a reason that names the size", mark)
                    boled.wait_for_log("calibration is for 640 x 480", 10)
                    expect(len(boled.log_lines("calibration is for 640 x 480")), 1, "log lines about it")
            with Camera([first_mode]) as camera:
                camera.plug()
                listener.wait_for_new_list(20)


def refuses_a_control():
    mode = frames.rendered("YUYV", SIZE)
    with Camera([mode]) as camera, Listener() as listener:
        camera.command("refuse gain")
        camera.plug()
        with Boled(f"v4l2:{camera.link}", SIZE, "source.gain=77") as boled:
            camera.wait_for_event("control_refused", 30, name="gain", value=77)
            listener.wait_for_list(30)
            expect(len(boled.log_lines("gain")), 1, "log lines about it")
            _, status = listener.wait_for_state("streaming", 10)
            expect(camera_events(status)["settings_refused"], 1, "settings refused")
