"""The USB camera of the rig (tests/hil/camera) as scenarios use it."""

import json
import os
import pathlib

from rig import environment
from rig.process import Process
from rig.wait import wait_until


class Camera(Process):
    """A USB camera that shows `modes` (rig.frames.Mode), unplugged at first. `port` tells several
    cameras apart, `serial` gives each a stable name below /dev/v4l/by-id. The first of the `rates`
    (frames a second) is the default: 10, since emulation on a busy machine cannot do 30."""

    def __init__(self, modes, serial="0001", rates=(10, 30, 15, 5), port=0):
        self.serial = serial
        self.link = pathlib.Path(f"/dev/v4l/by-id/usb-bole_Rig_Camera_{serial}-video-index0")
        super().__init__(
            f"camera{port}",
            [environment.build("tests/hil/hil_camera"), "--serial", serial, "--port", port,
             "--rates", ",".join(map(str, rates)), *map(str, modes)],
        )

    def end(self, timeout_s=30):
        """Returns when its stable name is gone: the next camera may have the same."""
        self.child.stdin.close()  # the end of its commands is the camera's end
        status = self.wait(timeout_s)
        self.wait_until_gone()
        return status

    def command(self, text):
        """Sends a command (see hil_camera's main.cpp) and waits until it has taken effect."""
        mark = self.stdout.mark()
        self.child.stdin.write(text + "\n")
        self.wait_for_event("done", 10, mark, command=text)

    def plug(self):
        """Plugs the camera in; returns when udev has given it its stable name."""
        self.command("plug")
        wait_until(self.link.exists, 20, f"{self.link} appears")

    def unplug(self):
        """Pulls the camera out; returns when its stable name is gone."""
        self.command("unplug")
        self.wait_until_gone()

    def wait_until_gone(self):
        wait_until(lambda: not os.path.lexists(self.link), 20, f"{self.link} disappears")

    @property
    def device(self):
        """/dev/videoN, which may be another after each plug()."""
        return self.link.resolve(strict=True)

    def events(self, kind, mark=0):
        """The events of this kind so far."""
        events = map(json.loads, self.stdout.since(mark))
        return [event for event in events if event["event"] == kind]

    def wait_for_event(self, kind, timeout_s, mark=0, **fields):
        """Waits for an event of this kind that has these fields; returns (time, event)."""
        wanted = {"event": kind, **fields}

        def matches(line):
            event = json.loads(line)
            return event if all(event.get(key) == wanted[key] for key in wanted) else None

        return self.stdout.wait_for(matches, timeout_s, f"camera: {wanted}", mark)
