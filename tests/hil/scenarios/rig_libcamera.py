"""The rig itself: libcamera's own tool lists the USB camera and streams from it, bit for bit."""

import shutil
import subprocess

from rig import environment, frames
from rig.camera import Camera
from rig.libcamera import camera_id, provide_firmware_node
from rig.wait import Skip, expect

SMOKE = True
TIME_LIMIT_S = 60


def run():
    if not shutil.which("cam"):
        raise Skip("cam (libcamera-tools) is not installed")
    provide_firmware_node()
    mode = frames.noise("YUYV", (640, 480))
    with Camera([mode, frames.noise("MJPG", (1280, 720))]) as camera:
        camera.plug()
        listing = cam("--list")
        assert camera_id(camera) in listing, f"{camera_id(camera)} is not listed:\n{listing}"
        recording = environment.SCRATCH / "cam"
        cam("--camera", camera_id(camera), "--stream", "width=640,height=480,pixelformat=YUYV",
            "--capture=5", f"--file={recording}")
        source = mode.frames()
        recorded = mode.split(recording.read_bytes())
        expect(len(recorded), 5, "frames")
        expect(sum(frame not in source for frame in recorded), 0, "frames that are not ours")


def cam(*arguments):
    return subprocess.run(["cam", *arguments], check=True, text=True, capture_output=True,
                          timeout=30).stdout
