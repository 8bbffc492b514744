"""What the Python tests share: the programs of a release build (BOLE_BUILD names another folder), the
generated message types, and a rendered drive. With BOLE_LONG=1 the bus tests take minutes: more and
longer outages."""

import os
import pathlib
import socket
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = pathlib.Path(os.environ.get("BOLE_BUILD", ROOT / "build/release"))
FRAMES = 20
LONG = os.environ.get("BOLE_LONG") == "1"


@pytest.fixture(scope="session")
def programs():
    return BUILD / "firmware_app"


@pytest.fixture(scope="session", autouse=True)
def cache(tmp_path_factory):
    """Warp tables are kept here, not in the user's own cache."""
    os.environ["XDG_CACHE_HOME"] = str(tmp_path_factory.mktemp("cache"))


@pytest.fixture(scope="session")
def types(tmp_path_factory):
    """The Python package that lcm-gen makes of our types."""
    folder = tmp_path_factory.mktemp("types")
    files = sorted((ROOT / "src/publish/types").glob("*.lcm"))
    subprocess.run(["lcm-gen", "-p", "--ppath", folder, *files], check=True)
    sys.path.insert(0, str(folder))
    import bole

    return bole


@pytest.fixture(scope="session")
def drive(programs, tmp_path_factory):
    """A folder of rendered frames with its camera.toml."""
    folder = tmp_path_factory.mktemp("drive")
    camera = ROOT / "calib/example/camera.toml"
    subprocess.run(
        [programs / "bolectl", "sim", "--out", folder, "--frames", str(FRAMES), "--seed", "7",
         "--camera", camera],
        check=True,
    )
    return folder


@pytest.fixture(scope="session")
def raw_drive(programs, tmp_path_factory):
    """A folder of few small raw frames, cheap to replay again and again."""
    folder = tmp_path_factory.mktemp("raw_drive")
    camera = ROOT / "tests/hil/cameras/640x480/camera.toml"
    subprocess.run(
        [programs / "bolectl", "sim", "--out", folder, "--frames", "4", "--seed", "7",
         "--camera", camera, "--format", "yuyv"],
        check=True,
    )
    return folder


@pytest.fixture
def lcm_url():
    """An address of this test's own, so that no other program's lists come in."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return f"udpm://239.255.76.67:{probe.getsockname()[1]}?ttl=0"


@pytest.fixture
def report(request, record_testsuite_property):
    """Notes figures in the results and, with -s, on the terminal."""

    def note(**figures):
        for name, value in figures.items():
            record_testsuite_property(f"{request.node.name}: {name}", value)
        print(request.node.name, figures)

    return note


@pytest.fixture
def boled(programs, drive):
    """Runs boled over the drive to its end; the finished process."""

    def run(*arguments, source=None, camera=drive / "camera.toml", prefix=()):
        command = [*prefix, programs / "boled", "--camera", camera, "--source",
                   source or f"replay:{drive}", *arguments]
        return subprocess.run(command, capture_output=True, text=True, timeout=60)

    return run


@pytest.fixture
def bolectl(programs):
    """Runs bolectl to its end; the finished process."""

    def run(*arguments):
        return subprocess.run([programs / "bolectl", *arguments], capture_output=True, text=True,
                              timeout=60)

    return run
