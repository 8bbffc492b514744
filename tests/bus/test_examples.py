"""The subscribers that ship with the package, against a daemon without a camera."""

import os
import pathlib
import subprocess
import sys

import pytest

from processes import eventually, free_endpoint, listening

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples"


def first_tree(command, environment=None):
    """What a subscriber prints first of a tree; it has 20 s for it."""
    command = ["timeout", "20", *command]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) as example:
        try:
            return next((line for line in example.stdout if line.startswith("#")), "")
        finally:
            example.terminate()


@pytest.fixture
def fake(programs):
    def start(*arguments):
        command = [programs / "bolectl", "publish-fake", *arguments]
        started.append(subprocess.Popen(command, stderr=subprocess.DEVNULL))

    started = []
    yield start
    for process in started:
        process.terminate()
        process.wait(10)


def test_python_subscriber_of_lcm(fake, types):
    fake("--publish", "lcm")
    environment = os.environ | {"PYTHONPATH": str(pathlib.Path(types.__file__).parents[1]),
                                "PYTHONUNBUFFERED": "1"}
    assert "rad" in first_tree([sys.executable, EXAMPLES / "subscribe_lcm.py"], environment)


def test_python_subscriber_of_zenoh(fake, types, programs):
    if not (programs.parent / "examples/subscribe_zenoh").exists():
        pytest.skip("built without Zenoh")
    endpoint = free_endpoint()
    fake("--publish", "zenoh", "--set", f"zenoh.listen=[\"{endpoint}\"]")
    assert eventually(lambda: listening(endpoint))
    environment = os.environ | {"PYTHONPATH": str(pathlib.Path(types.__file__).parents[1]),
                                "PYTHONUNBUFFERED": "1"}
    command = [sys.executable, EXAMPLES / "subscribe_zenoh.py", endpoint]
    assert "rad" in first_tree(command, environment)


def test_cpp_subscribers(fake, programs):
    fake("--publish", "lcm")
    assert "rad" in first_tree(["stdbuf", "-oL", programs.parent / "examples/subscribe_lcm"])
    zenoh = programs.parent / "examples/subscribe_zenoh"
    if not zenoh.exists():
        return
    endpoint = free_endpoint()
    fake("--publish", "zenoh", "--set", f"zenoh.listen=[\"{endpoint}\"]")
    assert eventually(lambda: listening(endpoint))
    assert "rad" in first_tree(["stdbuf", "-oL", zenoh, endpoint])
