"""The service under systemd: killed, stopped, its camera frozen and pulled out."""

import pathlib
import shutil
import subprocess
import time

from rig import environment, frames
from rig.appliance import Listener, camera_file
from rig.camera import Camera
from rig.wait import Skip, expect, wait_until

SMOKE = True
TIME_LIMIT_S = 300
SIZE = (640, 480)


def run():
    install()
    with Camera([frames.rendered("YUYV", SIZE)], rates=(10,)) as camera, Listener() as listener:
        configure(camera)
        # Its camera is not there yet: that is no reason not to be ready.
        seconds = {"start without a camera": timed(lambda: systemctl("start", "boled"))}
        listener.wait_for_state("no camera", 20)
        camera.plug()
        listener.wait_for_list(30)
        try:
            seconds["SIGKILL"] = restarted_after("KILL", listener)
            seconds["SIGSTOP"] = restarted_after("STOP", listener)
            recovers_by_itself(camera, listener)
        finally:
            seconds["stop"] = timed(lambda: systemctl("stop", "boled"))
            keep_journal()
        expect(show("Result"), "success", "the service's result after an orderly stop")
    return ", ".join(f"{what} {duration:.1f} s" for what, duration in seconds.items())


def install():
    """As `cmake --install` would."""
    if not (built := environment.build("firmware_app/boled")).exists():
        raise Skip("boled is not built")
    shutil.copy(built, "/usr/local/bin")
    unit = environment.source("systemd/boled.service.in").read_text()
    pathlib.Path("/etc/systemd/system/boled.service").write_text(
        unit.replace("@bindir@", "/usr/local/bin"))
    pathlib.Path("/etc/udev/rules.d").mkdir(exist_ok=True)
    shutil.copy(environment.source("systemd/70-bole-cameras.rules"), "/etc/udev/rules.d/")
    subprocess.run(["udevadm", "control", "--reload"], check=True)
    systemctl("daemon-reload")


def configure(camera, settings=""):
    """By the name that our udev rule gives; `settings` stand below [source]."""
    shutil.copytree(camera_file(SIZE).parent, "/etc/bole/camera", dirs_exist_ok=True)
    pathlib.Path("/etc/bole/boled.toml").write_text(
        f'[source]\nuri = "v4l2:/dev/bole/serial/{camera.serial}"\n{settings}')


def restarted_after(signal, listener):
    """Seconds from the signal to the next list of the restarted service."""
    restarts = int(show("NRestarts"))
    systemctl("kill", f"--signal={signal}", "--kill-whom=main", "boled")
    killed = time.monotonic()
    wait_until(lambda: int(show("NRestarts")) == restarts + 1, 60, f"a restart after {signal}")
    arrival, _ = listener.wait_for_new_list(30)
    return arrival - killed


def recovers_by_itself(camera, listener):
    """Frozen long enough for the watchdog, then unplugged and replugged: the same process goes on,
    since waiting for a camera is progress."""
    before = show("MainPID")
    watchdog_s = int(show("WatchdogUSec").removesuffix("s"))
    mark = listener.mark()
    camera.command("freeze")
    arrival, _ = listener.wait_for_state("stalled", 20, mark)
    listener.wait_for_status(lambda status: status["mono_ns"] / 1e9 > arrival + 2 * watchdog_s,
                             2 * watchdog_s + 20, "two of the watchdog's times")
    camera.command("run")
    listener.wait_for_new_list(30)
    camera.unplug()
    camera.plug()
    listener.wait_for_new_list(30)
    expect(show("MainPID"), before, "the service's process")
    assert "streaming" in show("StatusText"), show("StatusText")


def keep_journal():
    journal = subprocess.run(["journalctl", "-u", "boled", "-o", "short-monotonic"],
                             capture_output=True, text=True, check=True).stdout
    (environment.scenario_directory() / "journal").write_text(journal)


def systemctl(*words):
    subprocess.run(["systemctl", *words], check=True, capture_output=True, timeout=120)


def show(name):
    return subprocess.run(["systemctl", "show", "-P", name, "boled"], check=True,
                          capture_output=True, text=True).stdout.strip()


def timed(action):
    start = time.monotonic()
    action()
    return time.monotonic() - start
