"""bolectl listen against boled, and against those who misuse our channels."""

import contextlib
import json
import pathlib
import re
import subprocess
import time

import lcm
import pytest
from processes import eventually, free_endpoint, running


@contextlib.contextmanager
def listening(programs, lcm_url, *arguments):
    """bolectl listen from when it has subscribed on."""
    port = f":{int(re.search(r':([0-9]+)', lcm_url)[1]):04X} "
    command = [programs / "bolectl", "listen", "--lcm", lcm_url, *arguments]
    with running(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as listener:
        assert eventually(lambda: port in pathlib.Path("/proc/net/udp").read_text())
        time.sleep(0.5)  # LCM tries its own socket first
        yield listener


def test_listen_counts_lists_and_losses(programs, drive, lcm_url):
    with listening(programs, lcm_url, "--count", "20", "--json") as listener:
        subprocess.run([programs / "boled", "--camera", drive / "camera.toml", "--source",
                        f"replay:{drive}", "--publish", "lcm", "--set", f"lcm.url={lcm_url}"],
                       check=True, stderr=subprocess.DEVNULL)
        text, _ = listener.communicate(timeout=20)
    lines = [json.loads(line) for line in text.splitlines()]
    summary = lines[-1]["summary"]
    assert (summary["lists"], summary["lost"], summary["foreign"]) == (20, 0, 0)
    assert sum("trees" in line for line in lines) == 20
    assert any(line.get("state") == 2 for line in lines)


def test_listen_counts_each_camera_by_itself(programs, types, lcm_url):
    with listening(programs, lcm_url, "--count", "6", "--json") as listener:
        bus = lcm.LCM(lcm_url)
        for seq in range(3):
            for camera, first in [("front", 0), ("rear", 1000)]:
                message = types.tree_list_t()
                message.camera, message.seq = camera, first + seq
                bus.publish("BOLE_TREES", message.encode())
        text, _ = listener.communicate(timeout=20)
    summaries = {entry["stream"]: entry["summary"] for entry in map(json.loads, text.splitlines())
                 if "summary" in entry}
    assert summaries.keys() == {"BOLE_TREES front", "BOLE_TREES rear"}
    assert all((s["lists"], s["lost"], s["restarts"]) == (3, 0, 0) for s in summaries.values())


def test_listen_survives_and_names_foreign_payloads(programs, types, lcm_url):
    with listening(programs, lcm_url, "--count", "1", "--json") as listener:
        bus = lcm.LCM(lcm_url)
        bus.publish("BOLE_TREES", b"")
        bus.publish("BOLE_TREES", types.status_t().encode())
        bus.publish("BOLE_STATUS", b"\xff" * 100)
        bus.publish("BOLE_TREES", types.tree_list_t().encode())
        text, log = listener.communicate(timeout=20)
    assert listener.returncode == 0
    summaries = [entry["summary"] for entry in map(json.loads, text.splitlines())
                 if "summary" in entry]
    assert sum(summary["foreign"] for summary in summaries) == 3
    assert "is cut off" in log and "fingerprint" in log


def test_listen_ends_when_its_reader_has_gone(programs, types, lcm_url):
    with listening(programs, lcm_url) as listener:
        listener.stdout.close()
        lcm.LCM(lcm_url).publish("BOLE_TREES", types.tree_list_t().encode())
        assert listener.wait(5) == 1


def test_listen_takes_the_configuration_and_wonders_once_at_silence(programs, lcm_url, tmp_path):
    config = tmp_path / "boled.toml"
    config.write_text(f'lcm.url = "{lcm_url}"\n')
    command = [programs / "bolectl", "listen", "--config", config]
    with running(command, stderr=subprocess.PIPE, text=True) as listener:
        time.sleep(4.5)
        listener.terminate()
        log = listener.communicate(timeout=5)[1]
    (line,) = log.splitlines()
    assert f"nothing on {lcm_url} yet; is boled running" in line


def test_listen_says_that_nobody_answers_at_an_endpoint(programs):
    endpoint = free_endpoint()
    command = [programs / "bolectl", "listen", "--zenoh", endpoint]
    with running(command, stderr=subprocess.PIPE, text=True) as listener:
        time.sleep(4.5)
        listener.terminate()
        log = listener.communicate(timeout=5)[1]
    if "not in this build" in log:
        pytest.skip("built without Zenoh")
    (line,) = log.splitlines()
    assert f"cannot connect to {endpoint} yet; is boled running there" in line
    assert "Connection refused" in line


def test_a_planner_can_do_without_a_camera(programs, lcm_url):
    with listening(programs, lcm_url, "--count", "15", "--json") as listener:
        subprocess.run([programs / "bolectl", "publish-fake", "--count", "15", "--publish", "lcm",
                        "--set", f"lcm.url={lcm_url}"], check=True, stderr=subprocess.DEVNULL)
        text, _ = listener.communicate(timeout=20)
    lists = [entry for entry in map(json.loads, text.splitlines()) if "trees" in entry]
    assert len(lists) == 15
    assert all(entry["source"] == 3 for entry in lists)
    trees = [tree for entry in lists for tree in entry["trees"]]
    assert trees and all(0.9 <= tree["range"] <= 8.5 for tree in trees)
    kept = set(tree["id"] for tree in lists[0]["trees"]) & set(
        tree["id"] for tree in lists[-1]["trees"])
    assert kept  # a tree seen for a second keeps its id
