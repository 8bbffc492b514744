"""One boled on both buses at once, each read by a Python package that shares no code with ours."""

import json
import pathlib
import subprocess
import sys
import time

import lcm
import pytest
import zenoh

from processes import eventually, gaps, free_endpoint, listening

CLIENT = pathlib.Path(__file__).with_name("zenoh_client.py")


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
        eventually(lambda: daemon.poll() is not None or listening(endpoint))
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


def bus_health(session, types):
    """How the one bus of the only daemon does, by its last status."""
    (reply,) = session.get("bole/*/*/status", timeout=5)
    (bus,) = types.status_t.decode(reply.ok.payload.to_bytes()).buses
    return bus


def test_listen_reads_zenoh_and_names_foreign_payloads(programs, types, tmp_path):
    endpoint = free_endpoint()
    fake = subprocess.Popen(
        [programs / "bolectl", "publish-fake", "--publish", "zenoh", "--set", "zenoh.mode=router",
         "--set", f"zenoh.listen=[\"{endpoint}\"]"], stderr=subprocess.PIPE, text=True)
    try:
        eventually(lambda: fake.poll() is not None or listening(endpoint))
        if fake.poll() is not None and "not in this build" in fake.stderr.read():
            pytest.skip("built without Zenoh")
        listener = subprocess.Popen(
            [programs / "bolectl", "listen", "--zenoh", endpoint, "--count", "20", "--json"],
            stdout=open(tmp_path / "out", "w"), stderr=subprocess.PIPE, text=True)
        config = zenoh.Config()
        config.insert_json5("mode", '"client"')
        config.insert_json5("connect/endpoints", f'["{endpoint}"]')
        with zenoh.open(config) as session:
            end = time.monotonic() + 20
            while listener.poll() is None and time.monotonic() < end:
                session.put("bole/a/b/trees", b"not a list")
                time.sleep(0.1)
            log = listener.communicate()[1]
            entries = list(map(json.loads, (tmp_path / "out").read_text().splitlines()))
            seqs = [entry["seq"] for entry in entries if "trees" in entry]

            def dropped_up_to_the_last():
                """(Lists that the publisher had to drop,) once its status covers what was heard."""
                bus = bus_health(session, types)
                dropped = bus.overwritten + bus.failed
                return (dropped,) if bus.published + dropped > seqs[-1] else None

            (dropped,) = eventually(dropped_up_to_the_last)
    finally:
        listener.kill()
        fake.terminate()
        fake.wait(10)
    summaries = {entry["stream"]: entry["summary"] for entry in entries if "summary" in entry}
    (ours,) = [name for name in summaries if name.startswith("bole/robot/")]
    assert summaries[ours]["lists"] == 20
    # Nothing is lost but what a busy machine made the publisher overwrite.
    assert summaries[ours]["lost"] == gaps(seqs) <= dropped
    assert summaries["bole/a/b/trees"]["foreign"] > 0 and "fingerprint" in log
