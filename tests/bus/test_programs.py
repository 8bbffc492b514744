"""Exit codes, one-line errors, and what the daemon must not bring with it."""

import json
import os
import pathlib
import re
import shutil
import subprocess
import time

import pytest
from processes import free_endpoint, running


@pytest.mark.parametrize("program", ["boled", "bolectl", "bolectl detect", "bolectl lut info",
                                     "bolectl calib mount"])
def test_help_and_version(programs, program):
    name, *command = program.split()
    for option, text in [("--help", "Usage:"), ("--version", f"{name} ")]:
        run = subprocess.run([programs / name, *command, option], capture_output=True, text=True)
        assert run.returncode == 0
        assert text in run.stdout


@pytest.mark.parametrize("arguments, named", [
    ([], "subcommand"),
    (["detekt"], "detekt"),
    (["listen", "--count", "-1"], "--count"),
    (["listen", "--lcm", "udpm://239.255.76.67:7667", "--zenoh", "tcp/127.0.0.1:7447"], "--zenoh"),
])
def test_wrong_usage_of_bolectl_is_one_short_line(bolectl, arguments, named):
    run = bolectl(*arguments)
    assert run.returncode == 2
    assert named in run.stderr and run.stderr.count("\n") == 1 and len(run.stderr) < 100


@pytest.mark.parametrize("arguments, named", [
    (["--pace", "rate:0"], "rate:0"),
    (["--set", "detect.moode=paper"], "detect.moode"),
    (["--set", "publish.min_score=2"], "publish.min_score"),
    (["--set", "lcm.url=tcp"], "lcm.url"),
    (["--publish", "udp"], "udp"),
    (["--config", "/nonexistent.toml"], "/nonexistent.toml"),
    (["--nonsense"], "--nonsense"),
    (["--publish", "lcm,lcm"], "publish.to"),
    (["--loop", "--set", "source.loop=false"], "source.loop"),
    (["--publish", "lcm", "--set", 'publish.to=["zenoh"]'], "--publish"),
    (["--set", 'source.uri="v4l2:/dev/video9"'], "--source"),
])
def test_wrong_usage_is_one_line_and_exit_code_2(boled, arguments, named):
    run = boled(*arguments)
    assert run.returncode == 2
    assert run.stdout == ""
    assert named in run.stderr and run.stderr.count("\n") == 1


@pytest.mark.parametrize("source, arguments, named", [
    ("tape", [], "source.uri"),
    ("v4l2:/dev/video9", ["--loop"], "source.loop"),
])
def test_a_source_that_does_not_fit_is_one_line_and_exit_code_2(boled, source, arguments, named):
    run = boled(*arguments, source=source)
    assert run.returncode == 2
    assert named in run.stderr and run.stderr.count("\n") == 1


def test_results_that_cannot_be_written_are_no_success(programs, drive):
    with open("/dev/full", "w") as full:
        run = subprocess.run([programs / "bolectl", "detect", "--camera", drive / "camera.toml",
                              drive / "frame_000000.jpg"], stdout=full, stderr=subprocess.PIPE,
                             text=True)
    assert run.returncode == 1
    assert "standard output" in run.stderr and run.stderr.count("\n") == 1


def test_a_missing_camera_file_is_one_line_and_exit_code_2(boled):
    run = boled(camera="/nonexistent.toml")
    assert run.returncode == 2
    assert "/nonexistent.toml" in run.stderr and run.stderr.count("\n") == 1


def test_the_start_says_what_is_in_force(programs, boled, drive, tmp_path):
    version = subprocess.run([programs / "boled", "--version"], capture_output=True,
                             text=True).stdout.split()[1]
    config = tmp_path / "boled.toml"
    config.write_text('camera.name = "front"\npublish.to = ["lcm", "zenoh", "jsonl:lists"]\n'
                      f'lcm.url = "udpm://239.255.76.67:7671?ttl=0"\n'
                      f'zenoh.listen = ["{free_endpoint()}"]\n')
    table = tmp_path / "table"
    subprocess.run([programs / "bolectl", "lut", "build", "--camera", drive / "camera.toml", "--out",
                    table], check=True)
    log = boled("--config", config, "--set", f"camera.table={table}").stderr
    if "not in this build" in log:
        pytest.skip("built without Zenoh")
    (line,) = (line for line in log.splitlines() if "bole " in line)
    for text in [f"bole {version}:", str(config), "camera front", str(table),
                 "lcm (udpm://239.255.76.67:7671?ttl=0)", "zenoh (listens on tcp/127.0.0.1:",
                 f"jsonl ({tmp_path}/lists)"]:
        assert text in line, (text, line)


def test_boled_links_no_opencv(programs):
    libraries = subprocess.run(["ldd", programs / "boled"], capture_output=True, text=True).stdout
    assert "libc.so" in libraries and "opencv" not in libraries


def test_boled_names_no_folder_of_the_crates_that_it_was_built_from(programs):
    cargo = pathlib.Path(os.environ.get("CARGO_HOME") or pathlib.Path.home() / ".cargo")
    assert os.fsencode(cargo) not in (programs / "boled").read_bytes()


def test_boled_uses_little_memory_and_ends_at_sigterm(programs, drive):
    command = [programs / "boled", "--camera", drive / "camera.toml", "--source", f"replay:{drive}",
               "--pace", "rate:30", "--loop", "--publish", "jsonl:/dev/null"]
    with running(command, stderr=subprocess.PIPE, text=True) as daemon:
        time.sleep(3)
        status = pathlib.Path(f"/proc/{daemon.pid}/status").read_text()
        daemon.terminate()
        _, log = daemon.communicate(timeout=5)
    assert daemon.returncode == 0
    assert "latency p50" in log
    assert int(re.search(r"RssAnon:\s+(\d+) kB", status)[1]) < 40_000


def test_realtime_priority_is_that_of_all_but_processing_which_yields_to_them(programs, drive):
    command = [programs / "boled", "--camera", drive / "camera.toml", "--source", f"replay:{drive}",
               "--loop", "--publish", "lcm,zenoh", "--set", "service.realtime_priority=7", "--set",
               f'zenoh.listen=["{free_endpoint()}"]']
    with running(command, stderr=subprocess.PIPE, text=True) as daemon:
        time.sleep(1)
        threads = [stat.read_text().rpartition(") ")[2].split()
                   for stat in pathlib.Path(f"/proc/{daemon.pid}/task").glob("*/stat")]
        daemon.terminate()
        _, log = daemon.communicate(timeout=5)
    if "CAP_SYS_NICE" in log:
        pytest.skip("this user may not ask for SCHED_FIFO")
    # Fields 40 and 41 of proc(5), counted from the one behind the name.
    assert {thread[38] for thread in threads} == {str(os.SCHED_FIFO)}
    priorities = [thread[37] for thread in threads]
    assert priorities.count("6") == 1
    assert priorities.count("7") == len(threads) - 1 > 5  # zenoh has some of them


def test_lut_builds_a_table_that_fits_its_camera_only_and_whole(bolectl, drive, tmp_path):
    table = tmp_path / "table"
    camera = drive / "camera.toml"
    assert bolectl("lut", "build", "--camera", camera, "--out", table).returncode == 0
    shown = bolectl("lut", "info", "--camera", camera, table)
    assert shown.returncode == 0 and "panorama" in shown.stdout
    listed = json.loads(bolectl("lut", "info", "--json", "--camera", camera, table).stdout)
    assert listed["bytes"] == table.stat().st_size and 0.5 < listed["seen"] < 1
    damaged = bytearray(table.read_bytes())
    damaged[len(damaged) // 2] ^= 1
    table.write_bytes(damaged)
    refused = bolectl("lut", "info", "--camera", camera, table)
    assert refused.returncode == 2
    assert str(table) in refused.stderr and refused.stderr.count("\n") == 1


def test_eval_keeps_ids_over_two_frames_of_one_instant_as_the_daemon_does(bolectl, drive, tmp_path):
    truth = json.loads((drive / "truth.json").read_text())
    first = truth["frames"][0]
    truth["frames"] = [first, first | {"file": "again.jpg"}]
    (tmp_path / "truth.json").write_text(json.dumps(truth))
    shutil.copy(drive / first["file"], tmp_path / first["file"])
    shutil.copy(drive / first["file"], tmp_path / "again.jpg")
    run = bolectl("eval", "--json", "--camera", drive / "camera.toml", "--truth",
                  tmp_path / "truth.json", tmp_path)
    tracked = json.loads(run.stdout)["bole"]["tracked"]
    assert tracked["id_switches"] == 0 and tracked["recall"] > 0


def test_what_grab_writes_is_a_frame_for_every_command(bolectl, raw_drive, tmp_path):
    camera = raw_drive / "camera.toml"
    grabbed = bolectl("grab", "--camera", camera, "--source", f"replay:{raw_drive}", "--out",
                      tmp_path / "frame")
    assert grabbed.returncode == 0, grabbed.stderr
    frame = tmp_path / "frame.yuyv"
    assert [entry.name for entry in tmp_path.iterdir()] == [frame.name]
    for command in (["detect"], ["calib", "check"]):
        run = bolectl(*command, "--camera", camera, "--annotate", tmp_path / command[0], frame)
        assert run.returncode == 0, run.stderr
        assert (tmp_path / command[0] / "frame_panorama.png").exists()
    assert bolectl("eval", "--camera", camera, "--truth", raw_drive / "truth.json", "--plots",
                   tmp_path / "plots", raw_drive).returncode == 0


def test_sim_leaves_no_frames_of_two_recordings_in_one_folder(bolectl, tmp_path):
    camera = pathlib.Path(__file__).parents[1] / "hil/cameras/640x480/camera.toml"
    common = ["sim", "--out", tmp_path, "--seed", "1", "--camera", camera, "--frames"]
    assert bolectl(*common, "2").returncode == 0
    assert bolectl(*common, "2").returncode == 0
    shorter = bolectl(*common, "1")
    assert shorter.returncode == 2
    assert "frame_000001.jpg" in shorter.stderr and shorter.stderr.count("\n") == 1


def test_sim_finds_the_example_camera_from_wherever_it_is_started(programs, tmp_path):
    subprocess.run([programs / "bolectl", "sim", "--out", "drive", "--frames", "1", "--seed", "1"],
                   cwd=tmp_path, check=True)
    assert (tmp_path / "drive/camera.toml").exists()


def test_doctor_says_what_is_well_and_what_mends_the_rest(bolectl, drive):
    common = ["doctor", "--camera", drive / "camera.toml", "--publish", "lcm"]
    well = bolectl(*common, "--source", f"replay:{drive}")
    assert well.returncode == 0 and "BAD" not in well.stdout
    unmade = bolectl(*common, "--source", f"replay:{drive}", "--set", "camera.cache_directory=unmade")
    assert unmade.returncode == 0, unmade.stdout
    ill = bolectl(*common, "--source", "v4l2:/dev/v4l/by-id/nothing")
    assert ill.returncode == 1
    assert re.search("^BAD +source: .*nothing", ill.stdout, re.MULTILINE)


@pytest.mark.parametrize("settings, bad", [
    (["--publish", "zenoh", "--set", "zenoh.tls.ca=/nonexistent.pem"], "zenoh: .*nonexistent"),
    (["--publish", "zenoh", "--set", 'zenoh.mode="client"'], "zenoh: .*zenoh.connect"),
    (["--publish", "jsonl:/nonexistent/lists"], "jsonl: /nonexistent/lists"),
    (["--publish", "jsonl:/tmp"], "jsonl: /tmp is a directory"),
    (["--source", "libcamera:nothing"], "source: .*(nothing|install)"),
])
def test_doctor_takes_nothing_for_well_that_boled_would_refuse(bolectl, drive, settings, bad):
    source = [] if "--source" in settings else ["--source", f"replay:{drive}"]
    run = bolectl("doctor", "--camera", drive / "camera.toml", *source, *settings)
    if "zenoh" in settings and "not in this build" in run.stdout:
        pytest.skip("built without Zenoh")
    assert run.returncode == 1
    assert re.search(f"^BAD +{bad}", run.stdout, re.MULTILINE), run.stdout


def test_trace_shows_every_step_of_every_frame(boled, tmp_path):
    trace = tmp_path / "trace.json"
    assert boled("--pace", "fast", "--publish", "jsonl:/dev/null", "--trace",
                 trace).returncode == 0
    spans = [event for event in json.loads(trace.read_text()) if event["ph"] == "X"]
    assert {span["name"] for span in spans} >= {"wait for processing", "warp", "detect", "track",
                                                "encode", "hand over"}
    assert all(span["dur"] >= 0 for span in spans)
