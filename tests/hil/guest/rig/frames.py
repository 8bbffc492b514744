"""Frames for the cameras to show."""

import dataclasses
import pathlib
import random

from rig import environment
from rig.wait import Skip

# Bits per pixel of the formats that the rig's cameras have; MJPG has none.
BITS_PER_PIXEL = {
    "YUYV": 16, "UYVY": 16, "NV12": 12, "NM12": 12, "GREY": 8, "BA81": 8, "GBRG": 8, "GRBG": 8,
    "RGGB": 8, "BGR3": 24, "RGB3": 24,
}
USB_FORMATS = ("YUYV", "UYVY", "NV12", "GREY", "BA81", "GBRG", "GRBG", "RGGB", "BGR3", "MJPG")
SIZES = ((640, 480), (1280, 720))

# The project's names of the same formats.
PROJECT_NAMES = {
    "YUYV": "yuyv", "UYVY": "uyvy", "NV12": "nv12", "NM12": "nv12", "GREY": "grey", "BA81": "bggr",
    "GBRG": "gbrg", "GRBG": "grbg", "RGGB": "rggb", "BGR3": "bgr24", "RGB3": "rgb24",
    "MJPG": "mjpeg",
}

END_OF_JPEG = b"\xff\xd9"


@dataclasses.dataclass(frozen=True)
class Mode:
    """A pixel format and size, and a file of frames in it, one after another."""

    fourcc: str
    width: int
    height: int
    path: pathlib.Path

    def __str__(self):
        return f"{self.fourcc}:{self.width}x{self.height}:{self.path}"

    def split(self, data):
        """The frames in a recording of this mode."""
        if self.fourcc == "MJPG":
            return [part + END_OF_JPEG for part in data.split(END_OF_JPEG)[:-1]]
        size = self.width * self.height * BITS_PER_PIXEL[self.fourcc] // 8
        return [data[at:at + size] for at in range(0, len(data), size)]

    def frames(self):
        return self.split(self.path.read_bytes())


def rendered(fourcc, size, count=None):
    """A mode with the first `count` rendered pictures; all if None."""
    return recording(rendered_folder(fourcc, size), fourcc, size, count)


def recording(folder, fourcc, size, count=None):
    """A mode with the first `count` pictures of a folder; all if None."""
    width, height = size
    name = f"{folder.name}_{fourcc}_{width}x{height}_{count or 'all'}"
    mode = Mode(fourcc, width, height, environment.SCRATCH / name)
    if not mode.path.exists():
        files = sorted(folder.glob("frame_*"))[:count]
        mode.path.write_bytes(b"".join(file.read_bytes() for file in files))
    return mode


def rendered_folder(fourcc, size):
    """A few pictures of a wood (host/frames) in this format, ready to be replayed."""
    return _existing(environment.build("hil/frames", f"{size[0]}x{size[1]}", PROJECT_NAMES[fourcc]))


def drive_folder():
    """The pictures of a drive through a wood, 640 x 480 in YUYV."""
    return _existing(environment.build("hil/frames/640x480/drive"))


def _existing(folder):
    if not folder.exists():
        raise Skip(f"{folder} is not rendered")
    return folder


def noise(fourcc, size, count=4):
    """A mode with frames of random bytes: nothing that is shifted, swapped or lost can look right.
    No picture comes out of a decoder, but the kernel looks into no frame. Made once."""
    width, height = size
    mode = Mode(fourcc, width, height, environment.SCRATCH / f"noise_{fourcc}_{width}x{height}")
    if not mode.path.exists():
        numbers = random.Random(str(mode))
        mode.path.write_bytes(b"".join(_noise_frame(mode, numbers) for _ in range(count)))
    return mode


def _noise_frame(mode, numbers):
    if mode.fourcc == "MJPG":
        size = mode.width * mode.height // numbers.randint(8, 16)  # frames of different sizes
        return b"\xff\xd8" + numbers.randbytes(size).replace(b"\xff", b"\xfe") + END_OF_JPEG
    return numbers.randbytes(mode.width * mode.height * BITS_PER_PIXEL[mode.fourcc] // 8)
