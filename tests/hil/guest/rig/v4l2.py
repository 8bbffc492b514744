"""Video devices by way of v4l2-ctl: the rig's own eyes, independent of the project's capture."""

import pathlib
import re
import subprocess

from rig import environment
from rig.process import Process
from rig.wait import wait_until


def control_tool(device, *arguments):
    """Runs v4l2-ctl; returns what it printed. Raises CalledProcessError."""
    return subprocess.run(
        ["v4l2-ctl", "-d", str(device), *arguments], check=True, text=True, capture_output=True
    ).stdout


def set_format(device, mode):
    control_tool(device, format_option("video", mode))


def format_option(direction, mode):
    return f"--set-fmt-{direction}=width={mode.width},height={mode.height},pixelformat={mode.fourcc}"


def record(device, mode, count):
    """Streams `count` frames of `mode`; returns them."""
    set_format(device, mode)
    recording = environment.SCRATCH / "recording"
    control_tool(device, "--stream-mmap=4", f"--stream-count={count}", f"--stream-to={recording}")
    frames = mode.split(recording.read_bytes())
    recording.unlink()
    return frames


class Stream(Process):
    """Streams until the device is gone, no frame has come for two seconds, or the context is left.
    v4l2-ctl tells of each frame on its standard error."""

    def __init__(self, device):
        super().__init__("stream", ["v4l2-ctl", "-d", device, "--stream-mmap=4", "--stream-poll",
                                    "--verbose"])

    def sequences(self):
        """The driver's sequence numbers of the frames so far."""
        return [int(found[1]) for found in map(_SEQUENCE.search, self.stderr.since()) if found]

    def wait_for_frames(self, count, timeout_s=10):
        """Waits for this many more frames."""
        wanted = len(self.sequences()) + count
        wait_until(lambda: len(self.sequences()) >= wanted, timeout_s, f"{count} frames")


_SEQUENCE = re.compile(r"dqbuf:.*seq: *(\d+)")


def find_device(name_part):
    """/dev/videoN of the driver whose device name contains this; None if there is none."""
    for entry in sorted(pathlib.Path("/sys/class/video4linux").iterdir()):
        if name_part in (entry / "name").read_text():
            return pathlib.Path("/dev", entry.name)
    return None
