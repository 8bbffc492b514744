"""The guest around the scenarios: where things are, which modules are loaded."""

import os
import pathlib
import resource
import subprocess

OUT = pathlib.Path("/hil/out")
SCRATCH = pathlib.Path("/tmp")

_scenario = None


def source(*parts):
    """A path in the source tree."""
    return pathlib.Path(os.environ["HIL_SOURCE"], *parts)


def build(*parts):
    """A path in the build tree."""
    return pathlib.Path(os.environ["HIL_BUILD"], *parts)


def is_smoke():
    """Whether scenarios shall do the smaller part of what they can."""
    return os.environ["HIL_SELECTION"] == "smoke"


def prepare():
    """What every scenario needs, done once."""
    # A program that crashes leaves its core with the logs.
    resource.setrlimit(resource.RLIMIT_CORE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
    pathlib.Path("/proc/sys/kernel/core_pattern").write_text(f"{OUT}/core.%e.%p")
    subprocess.run(["modprobe", "-a", "vhci-hcd", "uvcvideo"], check=True)
    subprocess.run(["ip", "link", "set", "lo", "up"], check=True)
    subprocess.run(["ip", "route", "add", "239.0.0.0/8", "dev", "lo"], check=True)


def begin_scenario(name):
    global _scenario
    _scenario = name
    scenario_directory().mkdir()


def scenario_directory():
    """Where the running scenario's logs go; the host sees it when the guest is gone."""
    return OUT / _scenario
