"""The subscribers that ship with the package, against a daemon without a camera and against those who
misuse our channels and keys."""

import contextlib
import os
import pathlib
import select
import subprocess
import sys
import time

import lcm
import pytest
import zenoh

from processes import eventually, free_endpoint, listening

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples"
LCM_URL = "udpm://239.255.76.67:7667?ttl=0"  # the examples' own


@pytest.fixture
def example(programs, types):
    """The command of an example, and what its environment must hold."""

    def command(name, *arguments):
        if name.endswith(".py"):
            path = str(pathlib.Path(types.__file__).parents[1])
            environment = os.environ | {"PYTHONPATH": path, "PYTHONUNBUFFERED": "1"}
            return [sys.executable, EXAMPLES / name, *arguments], environment
        built = programs.parent / "examples" / name
        if not built.exists():
            pytest.skip("built without Zenoh")
        return ["stdbuf", "-oL", built, *arguments], os.environ

    return command


@contextlib.contextmanager
def running(command):
    """An example that has 30 s to show what it shall: its output and errors, line by line."""
    words, environment = command
    process = subprocess.Popen(["timeout", "30", *words], stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True, env=environment)
    try:
        yield process
    finally:
        process.terminate()
        process.wait(10)
        process.stdout.close()


def sees(process, text):
    """Whether a line with this text comes."""
    return any(text in line for line in process.stdout)


@contextlib.contextmanager
def fake(programs, *arguments):
    command = [programs / "bolectl", "publish-fake", *arguments]
    with subprocess.Popen(command, stderr=subprocess.DEVNULL) as process:
        try:
            yield
        finally:
            process.terminate()


def foreign_and_newer(types):
    """A payload that is nobody's, and a list as a later version might send it: another fingerprint,
    a field more."""
    newer = bytearray(types.tree_list_t().encode() + bytes(8))
    newer[7] ^= 1
    return b"not a list", bytes(newer)


@contextlib.contextmanager
def zenoh_router(endpoint):
    config = zenoh.Config()
    config.insert_json5("mode", '"router"')
    config.insert_json5("listen/endpoints", f'["{endpoint}"]')
    config.insert_json5("scouting/multicast/enabled", "false")
    with zenoh.open(config) as session:
        yield session


@pytest.mark.parametrize("name", ["subscribe_lcm.py", "subscribe_lcm"])
def test_a_subscriber_of_lcm_shows_trees(name, example, programs):
    with fake(programs, "--publish", "lcm"), running(example(name)) as shown:
        assert sees(shown, " rad, ")


@pytest.mark.parametrize("name", ["subscribe_zenoh.py", "subscribe_zenoh"])
def test_a_subscriber_of_zenoh_shows_trees(name, example, programs):
    endpoint = free_endpoint()
    command = example(name, endpoint)
    with fake(programs, "--publish", "zenoh", "--set", f'zenoh.listen=["{endpoint}"]'):
        assert eventually(lambda: listening(endpoint))
        with running(command) as shown:
            assert sees(shown, " rad, ")


def test_a_subscriber_of_zenoh_waits_for_boled(example, programs):
    endpoint = free_endpoint()
    with running(example("subscribe_zenoh.py", endpoint)) as shown:
        time.sleep(1.5)  # more than it takes to be refused
        with fake(programs, "--publish", "zenoh", "--set", f'zenoh.listen=["{endpoint}"]'):
            assert sees(shown, " rad, ")


# What they say of a payload that they cannot read; LCM's own C++ decoder only says that much.
@pytest.mark.parametrize("name, told", [
    ("subscribe_lcm.py", "BOLE_TREES is not of this version"),
    ("subscribe_lcm", "decoding tree_list_t"),
])
def test_a_subscriber_of_lcm_names_what_is_foreign_and_goes_on(name, told, example, types):
    bus = lcm.LCM(LCM_URL)
    tree = types.tree_t()
    good = types.tree_list_t()
    good.num_trees, good.trees = 1, [tree]
    for payload in foreign_and_newer(types):
        with running(example(name)) as shown:
            assert survives(shown, told, lambda: bus.publish("BOLE_TREES", payload),
                            lambda: bus.publish("BOLE_TREES", good.encode()))


@pytest.mark.parametrize("name, told", [
    ("subscribe_zenoh.py", "bole/robot/camera/trees is not of this version"),
    ("subscribe_zenoh", "bole/robot/camera/trees is not a bole.tree_list_t of this version"),
])
def test_a_subscriber_of_zenoh_names_what_is_foreign_and_goes_on(name, told, example, types):
    endpoint = free_endpoint()
    command = example(name, endpoint)
    good = types.tree_list_t()
    good.num_trees, good.trees = 1, [types.tree_t()]
    key = "bole/robot/camera/trees"
    with zenoh_router(endpoint) as router:
        for payload in foreign_and_newer(types):
            with running(command) as shown:
                assert survives(shown, told, lambda: router.put(key, payload),
                                lambda: router.put(key, good.encode()))


def survives(process, told, send_foreign, send_good):
    """Whether the example tells of what is foreign, then shows the tree of a good list. Sent again
    and again, since it may not listen yet."""
    for send, text in ((send_foreign, told), (send_good, " rad, ")):
        seen, end = "", time.monotonic() + 20
        while text not in seen and process.poll() is None and time.monotonic() < end:
            send()
            if select.select([process.stdout], [], [], 0.05)[0]:
                seen += os.read(process.stdout.fileno(), 65536).decode()
        if text not in seen:
            return False
    return True
