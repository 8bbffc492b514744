"""Exit codes, one-line errors, and what the daemon must not bring with it."""

import pathlib
import re
import subprocess
import time

import pytest


@pytest.mark.parametrize("program", ["boled", "bolectl"])
def test_help_and_version(programs, program):
    for option, text in [("--help", "Usage:"), ("--version", f"{program} ")]:
        run = subprocess.run([programs / program, option], capture_output=True, text=True)
        assert run.returncode == 0
        assert text in run.stdout


@pytest.mark.parametrize("arguments, named", [
    (["--pace", "rate:0"], "rate:0"),
    (["--set", "detect.moode=paper"], "detect.moode"),
    (["--set", "publish.min_score=2"], "publish.min_score"),
    (["--set", "lcm.url=tcp"], "lcm.url"),
    (["--publish", "udp"], "udp"),
    (["--config", "/nonexistent.toml"], "/nonexistent.toml"),
    (["--nonsense"], "--nonsense"),
])
def test_wrong_usage_is_one_line_and_exit_code_2(boled, arguments, named):
    run = boled(*arguments)
    assert run.returncode == 2
    assert run.stdout == ""
    assert named in run.stderr and run.stderr.count("\n") == 1


def test_a_missing_camera_file_is_one_line_and_exit_code_2(boled):
    run = boled(camera="/nonexistent.toml")
    assert run.returncode == 2
    assert "/nonexistent.toml" in run.stderr and run.stderr.count("\n") == 1


def test_boled_links_no_opencv(programs):
    libraries = subprocess.run(["ldd", programs / "boled"], capture_output=True, text=True).stdout
    assert "libc.so" in libraries and "opencv" not in libraries


def test_boled_uses_little_memory_and_ends_at_sigterm(programs, drive):
    command = [programs / "boled", "--camera", drive / "camera.toml", "--source", f"replay:{drive}",
               "--pace", "rate:30", "--loop", "--publish", "jsonl:/dev/null"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as daemon:
        time.sleep(3)
        status = pathlib.Path(f"/proc/{daemon.pid}/status").read_text()
        daemon.terminate()
        _, log = daemon.communicate(timeout=5)
    assert daemon.returncode == 0
    assert "latency p50" in log
    assert int(re.search(r"RssAnon:\s+(\d+) kB", status)[1]) < 40_000
