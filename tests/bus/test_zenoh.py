"""One boled on both buses at once, each read by a Python package that shares no code with ours."""

import socket
import subprocess
import sys
import time
import pathlib

import lcm
import pytest

CLIENT = pathlib.Path(__file__).with_name("zenoh_client.py")


def free_endpoint():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return f"tcp/127.0.0.1:{probe.getsockname()[1]}"


def test_the_same_lists_byte_for_byte_on_both_buses(programs, drive, lcm_url):
    endpoint = free_endpoint()
    received = {}
    bus = lcm.LCM(lcm_url)
    bus.subscribe("BOLE_TREES", lambda _, data: received.setdefault(data[32:40], data))
    command = [programs / "boled", "--camera", drive / "camera.toml", "--source", f"replay:{drive}",
               "--loop", "--publish", "lcm,zenoh", "--set", f"lcm.url={lcm_url}", "--set",
               f"zenoh.listen=[\"{endpoint}\"]"]
    daemon = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    try:
        time.sleep(1)
        if daemon.poll() is not None and "not in this build" in daemon.stderr.read():
            pytest.skip("built without Zenoh")
        client = subprocess.Popen(
            [sys.executable, CLIENT, endpoint, "subscribe", "bole/*/*/trees", "15"],
            stdout=subprocess.PIPE, text=True)
        while client.poll() is None:
            bus.handle_timeout(50)
        samples = [line.split() for line in client.stdout.read().splitlines() if line != "ready"]
    finally:
        daemon.terminate()
        daemon.wait(10)
    assert len(samples) == 15
    for _, encoding, payload in samples:
        data = bytes.fromhex(payload)
        assert encoding == "application/octet-stream;bole.tree_list_t"
        assert received[data[32:40]] == data
