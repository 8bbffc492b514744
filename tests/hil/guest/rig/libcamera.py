"""What libcamera needs in the guest."""

import pathlib
import subprocess

_HIDDEN_SYS = pathlib.Path("/run/sys")
FIRMWARE_NODE = r"\_SB_.RIG0"


def provide_firmware_node():
    """libcamera names a USB camera by the firmware node above it, and takes none that has no such
    node; vhci_hcd is a platform device without one. So /sys becomes a tmpfs that shows all of the
    real one, and firmware_node/path at its root. Done once; programs started later see it."""
    node = pathlib.Path("/sys/firmware_node")
    if node.exists():
        return
    _HIDDEN_SYS.mkdir()
    subprocess.run(["mount", "--rbind", "/sys", _HIDDEN_SYS], check=True)
    subprocess.run(["mount", "--make-rprivate", _HIDDEN_SYS], check=True)
    subprocess.run(["mount", "-t", "tmpfs", "-o", "mode=755", "sys", "/sys"], check=True)
    for directory in _HIDDEN_SYS.iterdir():
        if directory.is_dir():
            shown = pathlib.Path("/sys", directory.name)
            shown.mkdir()
            subprocess.run(["mount", "--rbind", directory, shown], check=True)
    node.mkdir()
    (node / "path").write_text(FIRMWARE_NODE + "\n")
    subprocess.run(["mount", "-o", "remount,ro", "/sys"], check=True)


def camera_id(camera):
    """libcamera's name of a rig camera in the first port of vhci_hcd: firmware node, USB port,
    vendor and product."""
    return rf"{FIRMWARE_NODE}-1:1.0-1209:0001"
