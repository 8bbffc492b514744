"""vivid, the kernel's virtual video driver: its output looped to its capture shows our frames."""

import subprocess

from rig import v4l2
from rig.process import Process
from rig.wait import wait_until

# CVT's pixel clock for 640x480 at 30 Hz is below the least that vivid takes (14 MHz).
_TIMINGS = "--set-dv-bt-timings=cvt,width={mode.width},height={mode.height},fps=45"


class Loop:
    """vivid with one HDMI output that plays a mode's frames over and over, and one HDMI input that
    it is plugged into; `device` is the input. Loaded with the context, unloaded at its end."""

    def __init__(self, mode, multiplanar):
        self.mode = mode
        self.multiplanar = multiplanar

    def __enter__(self):
        # node_types: video capture (bit 0) and video output (bit 8); input and output type: HDMI.
        load("n_devs=1", "node_types=0x101", "num_inputs=1", "input_types=0x3", "num_outputs=1",
             "output_types=0x1", f"multiplanar={2 if self.multiplanar else 1}")
        self.device = wait_until(lambda: v4l2.find_device("vid-cap"), 10, "vivid's capture device")
        output = wait_until(lambda: v4l2.find_device("vid-out"), 10, "vivid's output device")
        wait_until(lambda: self.device.exists() and output.exists(), 10, "vivid's device nodes")
        v4l2.control_tool(self.device, "-c", "osd_text_mode=2", "-c", "loop_video=1")
        for end in (self.device, output):
            v4l2.control_tool(end, _TIMINGS.format(mode=self.mode))
        v4l2.set_format(self.device, self.mode)
        v4l2.control_tool(output, v4l2.format_option("video-out", self.mode))
        self._player = Process("player", [
            "v4l2-ctl", "-d", output, "--stream-out-mmap=4", "--stream-loop", "--verbose",
            f"--stream-from={self.mode.path}"])
        self._player.stderr.wait_for(lambda line: "seq:" in line, 10, "vivid plays")
        return self

    def __exit__(self, *_):
        self._player.end()
        unload()


def load(*parameters):
    subprocess.run(["modprobe", "vivid", *parameters], check=True)


def unload():
    subprocess.run(["rmmod", "vivid"], check=True)
