"""boled over a rendered drive: what comes out, and that others read the same."""

import json
import os
import re
import subprocess
import time

import lcm
import pytest
from processes import running


def lists(text):
    return [json.loads(line) for line in text.splitlines()]


def test_lockstep_is_byte_identical_over_ten_runs(boled):
    runs = {boled("--pace", "lockstep", "--publish", "jsonl:-").stdout for _ in range(10)}
    assert len(runs) == 1
    (text,) = runs
    found = lists(text)
    assert [entry["seq"] for entry in found] == list(range(20))
    assert all(entry["publish_mono_ns"] == entry["capture_mono_ns"] for entry in found)
    assert sum(entry["num_trees"] for entry in found) > 0


def test_a_file_of_lists_outlives_a_restart_and_is_the_same_after_each_run_in_lockstep(
    boled, tmp_path
):
    kept = tmp_path / "lists.jsonl"
    for _ in range(2):
        boled("--pace", "lockstep", "--publish", f"jsonl:{kept}")
    first = kept.read_text()
    assert len(lists(first)) == 20
    boled("--pace", "rate:100", "--publish", f"jsonl:{kept}")
    assert kept.read_text().startswith(first) and len(kept.read_text()) > len(first)


class Receiver:
    """Keeps every list of a URL, read with the generated type alone."""

    def __init__(self, url, types):
        self.lcm = lcm.LCM(url)
        self.payloads = []
        subscription = self.lcm.subscribe("BOLE_TREES", lambda _, data: self.payloads.append(data))
        subscription.set_queue_capacity(0)
        self.types = types

    def receive(self, count, seconds):
        end = time.monotonic() + seconds
        while len(self.payloads) < count and time.monotonic() < end:
            self.lcm.handle_timeout(100)
        return [self.types.tree_list_t.decode(data) for data in self.payloads]


def same(message, line):
    fields = set(line) - {"file", "trees"}
    assert {name: getattr(message, name) for name in fields} == {name: line[name] for name in fields}
    for tree, written in zip(message.trees, line["trees"], strict=True):
        for name, value in written.items():
            assert getattr(tree, name) == pytest.approx(value, rel=1e-6), name


def test_realtime_publishes_every_frame_on_lcm_as_jsonl_has_it(
    programs, drive, types, lcm_url, tmp_path
):
    receiver = Receiver(lcm_url, types)
    written = tmp_path / "lists.jsonl"
    command = [programs / "boled", "--camera", drive / "camera.toml", "--source", f"replay:{drive}",
               "--pace", "realtime", "--publish", f"lcm,jsonl:{written}", "--set",
               f"lcm.url={lcm_url}"]
    with running(command, stderr=subprocess.PIPE, text=True) as daemon:
        received = {message.seq: message for message in receiver.receive(20, 10)}
        log = daemon.communicate(timeout=20)[1]
    assert daemon.returncode == 0
    lines = {line["seq"]: line for line in lists(written.read_text())}

    # All 20, unless the machine was too busy with others: what was left out is counted then.
    made, drops = re.search(r"(\d+) lists, drops:(.*)", log).groups()
    assert int(made) + sum(map(int, re.findall(r"\d+", drops))) == 20
    for bus, arrived in [("lcm", received), ("jsonl", lines)]:
        published, overwritten = re.search(rf"{bus}: (\d+) published, (\d+) over", log).groups()
        assert len(arrived) == int(published) == int(made) - int(overwritten)
    both = lines.keys() & received.keys()
    assert both
    for seq in both:
        same(received[seq], lines[seq])


def test_bad_file_is_named_and_the_others_go_on(boled, drive, tmp_path):
    for file in drive.iterdir():
        (tmp_path / file.name).write_bytes(file.read_bytes())
    bad = sorted(tmp_path.glob("frame_*"))[7]
    bad.write_bytes(bad.read_bytes()[:2000])
    run = boled("--pace", "lockstep", "--publish", "jsonl:-", source=f"replay:{tmp_path}")
    assert run.returncode == 0
    found = lists(run.stdout)
    assert len(found) == 19
    assert bad.name not in [entry["file"] for entry in found]
    assert bad.name in run.stderr
    assert [entry["sensor_seq"] for entry in found] == [k for k in range(20) if k != 7]


def test_without_a_multicast_route_the_error_is_clear_and_jsonl_goes_on(boled):
    try:
        subprocess.run(["unshare", "-n", "true"], check=True, capture_output=True)
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("no network namespaces here")
    run = boled("--pace", "lockstep", "--publish", "lcm,jsonl:-", prefix=["unshare", "-n"])
    assert run.returncode == 0
    assert len(lists(run.stdout)) == 20
    assert run.stderr.count("no multicast route") == 1


def test_a_full_disk_is_told_once_and_no_success_in_lockstep(boled):
    run = boled("--pace", "lockstep", "--publish", "jsonl:/dev/full")
    assert run.returncode == 1
    assert run.stderr.count("(tried again with every message)") == 1
    assert "publishing again" not in run.stderr
    assert "20 lists are lost" in run.stderr.splitlines()[-1]


@pytest.mark.parametrize("program", ["boled", "publish-fake"])
def test_a_reader_that_stops_does_not_keep_boled_from_ending(programs, drive, program):
    command = [programs / "boled", "--camera", drive / "camera.toml", "--source", f"replay:{drive}",
               "--pace", "fast", "--loop", "--publish", "jsonl:-"]
    if program == "publish-fake":
        command = [programs / "bolectl", "publish-fake", "--rate", "1000", "--publish", "jsonl:-"]
    with running(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as daemon:
        daemon.stdout.readline()
        time.sleep(1)  # the pipe fills
        daemon.terminate()
        assert daemon.wait(5) == 0


def test_a_pipe_that_nobody_reads_is_an_error_and_nothing_to_wait_for(boled, tmp_path):
    os.mkfifo(tmp_path / "pipe")
    run = boled("--publish", f"jsonl:{tmp_path}/pipe")
    assert run.returncode == 2
    assert f"publish.to: jsonl:{tmp_path}/pipe cannot be written: No such device" in run.stderr


def test_boled_ends_when_the_only_reader_has_gone(programs, drive):
    command = [programs / "boled", "--camera", drive / "camera.toml", "--source", f"replay:{drive}",
               "--loop", "--publish", "jsonl:-"]
    with running(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as daemon:
        daemon.stdout.readline()
        daemon.stdout.close()
        assert daemon.wait(5) == 0


def test_a_closed_standard_output_is_taken_for_dev_null(programs, drive):
    command = [programs / "boled", "--camera", drive / "camera.toml", "--source", f"replay:{drive}",
               "--pace", "lockstep", "--publish", "jsonl:-"]
    with running(command, stderr=subprocess.PIPE, preexec_fn=lambda: os.close(1)) as daemon:
        assert daemon.wait(20) == 0
        assert b"20 published" in daemon.stderr.read()
