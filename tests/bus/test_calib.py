"""bolectl calib as its user meets it: what is printed, exit codes, one-line errors."""

import json
import re

import pytest


def falsified(drive, folder, change):
    """The drive's camera.toml, in another folder, with its text changed."""
    text = re.sub(r'(?m)^(calibration|mask) = "(.*)"', rf'\1 = "{drive}/\2"',
                  (drive / "camera.toml").read_text())
    camera = folder / "camera.toml"
    camera.write_text(change(text))
    return camera


def test_check_describes_a_camera_in_words_and_json(bolectl, drive):
    camera = drive / "camera.toml"
    shown = bolectl("calib", "check", "--camera", camera)
    assert shown.returncode == 0 and shown.stderr == ""
    assert "1280 x 960" in shown.stdout and "warning" not in shown.stdout
    listed = json.loads(bolectl("calib", "check", "--json", "--camera", camera).stdout)
    assert listed["image_width"] == 1280 and listed["warnings"] == []
    assert listed["there_and_back"]["most_px"] < 1e-6


def test_check_warns_of_what_is_likely_a_mistake(bolectl, drive, tmp_path):
    camera = falsified(drive, tmp_path, lambda text: text.replace("columns = 1440", "columns = 4096"))
    shown = bolectl("calib", "check", "--camera", camera)
    assert shown.returncode == 0
    assert re.search(r"(?m)^warning .*panorama\.columns", shown.stdout)


def test_check_draws_the_horizon_into_two_pictures(bolectl, drive, tmp_path):
    run = bolectl("calib", "check", "--camera", drive / "camera.toml", "--annotate", tmp_path / "out",
                  drive / "frame_000000.jpg")
    assert run.returncode == 0
    assert sorted(file.name for file in (tmp_path / "out").iterdir()) == [
        "frame_000000_panorama.png", "frame_000000_raw.png"]


@pytest.mark.parametrize("tilt", [0, 3])
def test_mount_finds_the_mount_and_edits_nothing(bolectl, drive, tmp_path, tilt):
    camera = falsified(drive, tmp_path, lambda text: re.sub(
        r"(?m)^pitch_deg = (\S+)", lambda match: f"pitch_deg = {float(match[1]) + tilt}", text))
    before = camera.read_text()
    run = bolectl("calib", "mount", "--json", "--camera", camera, drive)
    assert run.returncode == 0
    found = json.loads(run.stdout)
    truth = json.loads((drive / "truth.json").read_text())
    for key in ("roll_deg", "pitch_deg"):
        assert abs(found[key]["new"] - truth[key]) < 3 * found[key]["sigma"] < 1.5
    assert found["frames"] == 20 and found["unreadable"] == 0
    assert camera.read_text() == before


def test_mount_finds_the_height_by_measured_trees(bolectl, drive, tmp_path):
    truth = json.loads((drive / "truth.json").read_text())
    frame = truth["frames"][0]
    listed = json.loads(bolectl("detect", "--camera", drive / "camera.toml",
                                drive / frame["file"]).stdout)["trees"]
    sure = [tree for tree in frame["trees"] if 1.5 < tree["range"] < 7 and tree["foot_visible"] > 0.9
            and any(abs(seen["bearing"] - tree["bearing"]) < 0.02 and seen["score"] > 0.8
                    for seen in listed)]
    trees = [option for tree in sure[:3]
             for option in ("--tree", f"{tree['bearing'] * 57.29578:.2f},{tree['range']:.2f}")]
    assert trees
    camera = falsified(drive, tmp_path, lambda text: text.replace("1.05", "0.95"))
    run = bolectl("calib", "mount", "--camera", camera, *trees, drive / frame["file"])
    assert run.returncode == 0, run.stderr
    height = float(re.search(r"(?m)^height_m = (\S+)", run.stdout)[1])
    assert abs(height - 1.05) < 0.08


def test_mount_leaves_out_what_it_cannot_read_and_says_so(bolectl, drive, tmp_path):
    bad = tmp_path / "bad.jpg"
    bad.write_bytes(b"no picture")
    run = bolectl("calib", "mount", "--json", "--camera", drive / "camera.toml", drive, bad,
                  tmp_path / "missing.png")
    assert run.returncode == 0
    assert json.loads(run.stdout)["unreadable"] == 2
    assert "bad.jpg" in run.stderr and "missing.png" in run.stderr


def test_mount_refuses_frames_that_do_not_tell(bolectl, drive, tmp_path):
    bad = tmp_path / "bad.jpg"
    bad.write_bytes(b"no picture")
    run = bolectl("calib", "mount", "--camera", drive / "camera.toml", bad)
    assert run.returncode == 1 and run.stdout == "" and run.stderr.count("\n") == 1
    treeless = tmp_path / "treeless"
    bolectl("sim", "--out", treeless, "--frames", "1", "--seed", "3", "--preset", "treeless",
            "--camera", drive / "camera.toml")
    run = bolectl("calib", "mount", "--camera", drive / "camera.toml", treeless)
    assert run.returncode == 1 and run.stdout == "" and run.stderr.count("\n") == 1
    assert "take frames" in run.stderr


def test_mount_refuses_a_measured_tree_that_is_not_there(bolectl, drive):
    listed = json.loads(bolectl("detect", "--camera", drive / "camera.toml",
                                drive / "frame_000000.jpg").stdout)["trees"]
    seen = [tree["bearing"] for tree in listed]
    empty = max(range(-180, 180), key=lambda b: min(abs((b / 57.29578 - s + 3.14159) % 6.28318 - 3.14159)
                                                    for s in seen))
    run = bolectl("calib", "mount", "--camera", drive / "camera.toml", "--tree", f"{empty},3",
                  drive / "frame_000000.jpg")
    assert run.returncode == 1 and run.stdout == ""
    assert str(empty) in run.stderr and run.stderr.count("\n") == 1


@pytest.mark.parametrize("tree", ["nan,3", "10,nan", "10", "10,3,4", "", "400,3", "10,-3", "10,inf",
                                  "a,b", "10,3m"])
def test_a_measured_tree_that_is_none_is_wrong_usage(bolectl, drive, tree):
    run = bolectl("calib", "mount", "--camera", drive / "camera.toml", "--tree", tree, drive)
    assert run.returncode == 2 and run.stdout == ""
    assert "--tree" in run.stderr and run.stderr.count("\n") == 1


@pytest.mark.parametrize("arguments, named", [
    (["check"], "--camera"),
    (["check", "--camera", "/nonexistent.toml"], "/nonexistent.toml"),
    (["check", "--camera", "{camera}", "--annotate", "{empty}"], "--annotate"),
    (["check", "--camera", "{camera}", "{empty}"], "--annotate"),
    (["mount", "--camera", "{camera}"], "FRAMES"),
    (["mount", "--camera", "{camera}", "{empty}"], "holds no frame"),
])
def test_wrong_usage_of_calib_is_one_line_and_exit_code_2(bolectl, drive, tmp_path, arguments, named):
    run = bolectl("calib", *[text.format(camera=drive / "camera.toml", empty=tmp_path)
                             for text in arguments])
    assert run.returncode == 2 and run.stdout == ""
    assert named in run.stderr and run.stderr.count("\n") == 1
