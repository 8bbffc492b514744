"""The project's udev rule: names that stay with the camera, or with its port."""

import pathlib
import shutil
import subprocess

from rig import environment, frames
from rig.camera import Camera
from rig.wait import expect, wait_until

SMOKE = False
TIME_LIMIT_S = 60
RULES = "70-bole-cameras.rules"


def run():
    directory = pathlib.Path("/run/udev/rules.d")
    directory.mkdir(parents=True, exist_ok=True)
    shutil.copy(environment.source("systemd", RULES), directory)
    subprocess.run(["udevadm", "control", "--reload"], check=True)
    with Camera([frames.noise("YUYV", (640, 480))], serial="K0042") as camera:
        camera.plug()
        by_serial = pathlib.Path("/dev/bole/serial/K0042")
        wait_until(by_serial.exists, 10, f"{by_serial} appears")
        expect(by_serial.resolve(), camera.device, "the camera of that serial number")
        # Names of devices that are gone may still be on their way out.
        wait_until(lambda: devices_by_port() == [camera.device], 10, "only the camera has a port")
        camera.unplug()
        wait_until(lambda: not by_serial.exists(), 10, f"{by_serial} disappears")


def devices_by_port():
    return [name.resolve() for name in pathlib.Path("/dev/bole/port").iterdir()]
