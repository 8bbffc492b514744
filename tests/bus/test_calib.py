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


@pytest.mark.parametrize("wrong", ["pitch_deg = 90", "roll_deg = 180"])
def test_check_warns_of_a_grossly_wrong_mount(bolectl, drive, tmp_path, wrong):
    key = wrong.split()[0]
    camera = falsified(drive, tmp_path, lambda text: re.sub(rf"(?m)^{key} = .*", wrong, text))
    shown = bolectl("calib", "check", "--camera", camera)
    assert shown.returncode == 0
    assert re.search(r"(?m)^warning .*mount\.roll_deg", shown.stdout)


def test_check_draws_the_horizon_into_two_pictures(bolectl, drive, tmp_path):
    run = bolectl("calib", "check", "--camera", drive / "camera.toml", "--annotate", tmp_path / "out",
                  drive / "frame_000000.jpg")
    assert run.returncode == 0
    assert sorted(file.name for file in (tmp_path / "out").iterdir()) == [
        "frame_000000_panorama.png", "frame_000000_raw.png"]


def test_check_draws_on_what_it_can_and_names_the_rest(bolectl, drive, tmp_path):
    bad = tmp_path / "bad.jpg"
    bad.write_bytes(b"no picture")
    run = bolectl("calib", "check", "--camera", drive / "camera.toml", "--annotate", tmp_path / "out",
                  bad, drive / "frame_000000.jpg")
    assert run.returncode == 1
    assert "bad.jpg" in run.stderr and "1 of 2" in run.stderr
    assert (tmp_path / "out" / "frame_000000_raw.png").exists()


@pytest.mark.parametrize("command", [["calib", "check"], ["detect"]])
def test_annotate_refuses_what_cannot_be_written_before_anything_is_done(bolectl, drive, tmp_path,
                                                                         command):
    frame = drive / "frame_000000.jpg"
    again = tmp_path / frame.name
    again.write_bytes(frame.read_bytes())
    occupied = tmp_path / "file"
    occupied.write_text("")
    for folder, images, named in [(tmp_path / "out", [frame, again], str(again)),
                                  (occupied, [frame], str(occupied))]:
        run = bolectl(*command, "--camera", drive / "camera.toml", "--annotate", folder, *images)
        assert run.returncode == 2 and run.stdout == ""
        assert "--annotate" in run.stderr and named in run.stderr and run.stderr.count("\n") == 1
    assert not (tmp_path / "out").exists()


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
        assert abs(found[key]["new"] - truth[key]) < 2.5 * found[key]["sigma"] < 1
    assert found["frames"] == 20 and found["left_out"] == []
    assert found["lean_against_feet_deg"].keys() == {"forward", "left"}
    assert len(found["warnings"]) == run.stderr.count("warning")
    assert camera.read_text() == before


def test_mount_hardly_moves_its_own_result(bolectl, drive, tmp_path):
    def run(camera):
        return json.loads(bolectl("calib", "mount", "--json", "--camera", camera, drive).stdout)

    def set_to(found):
        return lambda text: re.sub(
            r"(?m)^(roll_deg|pitch_deg) = .*", lambda key: f"{key[1]} = {found[key[1]]['new']:.2f}", text)

    first = run(falsified(drive, tmp_path, lambda text: re.sub(
        r"(?m)^roll_deg = (\S+)", lambda match: f"roll_deg = {float(match[1]) + 4}", text)))
    again = run(falsified(drive, tmp_path, set_to(first)))
    for key in ("roll_deg", "pitch_deg"):
        assert abs(again[key]["new"] - first[key]["new"]) < 0.3 * first[key]["sigma"]


def test_mount_counts_a_frame_once_however_often_it_is_named(bolectl, drive, tmp_path):
    frames = [drive / f"frame_{number:06}.jpg" for number in range(4)]
    links = tmp_path / "links"
    links.mkdir()
    for frame in frames:
        (links / frame.name).symlink_to(frame)

    def run(*frames):
        return bolectl("calib", "mount", "--json", "--camera", drive / "camera.toml", *frames).stdout

    once = run(links)
    assert json.loads(once)["frames"] == 4
    assert run(*frames, links, frames[2]) == once


def test_mount_reads_raw_frames(bolectl, drive, tmp_path):
    raw = tmp_path / "raw"
    bolectl("sim", "--out", raw, "--frames", "8", "--seed", "7", "--format", "yuyv",
            "--camera", drive / "camera.toml")
    (raw / "frame_000002.yuyv").write_bytes(b"short")
    run = bolectl("calib", "mount", "--json", "--camera", drive / "camera.toml", raw)
    assert run.returncode == 0, run.stderr
    found = json.loads(run.stdout)
    assert found["frames"] == 7
    assert [image["file"] for image in found["left_out"]] == [str(raw / "frame_000002.yuyv")]
    assert "bytes" in found["left_out"][0]["error"]


def test_mount_proposes_no_change_that_the_frames_do_not_tell(bolectl, drive, tmp_path):
    right = bolectl("calib", "mount", "--camera", drive / "camera.toml", drive).stdout
    assert "leave [mount]" in right and "roll_deg =" not in right
    camera = falsified(drive, tmp_path, lambda text: re.sub(
        r"(?m)^pitch_deg = (\S+)", lambda match: f"pitch_deg = {float(match[1]) + 3}", text))
    tilted = bolectl("calib", "mount", "--camera", camera, drive).stdout
    assert "pitch_deg =" in tilted and "roll_deg =" not in tilted


def test_mount_finds_the_horizon_of_a_camera_that_looks_ahead(bolectl, tmp_path):
    camera = tmp_path / "camera.toml"
    text = """
[camera]
model = "pinhole"
horizontal_fov_deg = 100
width = 800
height = 600
[mount]
height_m = 1.2
horizon_row = {row}
[panorama]
range_min_m = 1.5
"""
    camera.write_text(text.format(row=275))
    bolectl("sim", "--out", tmp_path / "frames", "--frames", "16", "--seed", "5", "--preset", "varied",
            "--camera", camera)
    camera.write_text(text.format(row=290))
    run = bolectl("calib", "mount", "--camera", camera, tmp_path / "frames")
    assert run.returncode == 0, run.stderr
    row, sigma = map(float, re.search(r"(?m)^horizon_row 290.0 -> (\S+) \S+ (\S+)", run.stdout).groups())
    # On slopes of up to 14 degrees, which a camera that looks one way can hardly tell from a pitch.
    assert abs(row - 275) < 3 * sigma < 30
    assert "pitch_deg" not in run.stdout


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
    height = float(re.search(r"(?m)^height_m +0.950 -> (\S+)", run.stdout)[1])
    assert abs(height - 1.05) < 0.08


def test_mount_leaves_out_what_it_cannot_read_and_says_so(bolectl, drive, tmp_path):
    bad = tmp_path / "bad.jpg"
    bad.write_bytes(b"no picture")
    run = bolectl("calib", "mount", "--json", "--camera", drive / "camera.toml", drive, bad)
    assert run.returncode == 0
    assert json.loads(run.stdout)["left_out"] == [{"file": str(bad), "error": "is no image"}]
    assert f"left out: {bad}: is no image" in run.stderr


def test_mount_refuses_frames_that_do_not_tell(bolectl, drive, tmp_path):
    bad = tmp_path / "bad.jpg"
    bad.write_bytes(b"no picture")
    run = bolectl("calib", "mount", "--camera", drive / "camera.toml", bad)
    assert run.returncode == 1 and run.stdout == "" and run.stderr.count("\n") == 1
    assert f"{bad}: is no image" in run.stderr
    treeless = tmp_path / "treeless"
    bolectl("sim", "--out", treeless, "--frames", "1", "--seed", "3", "--preset", "treeless",
            "--camera", drive / "camera.toml")
    run = bolectl("calib", "mount", "--camera", drive / "camera.toml", treeless, bad)
    assert run.returncode == 1 and run.stdout == "" and run.stderr.count("\n") == 1
    assert "take frames" in run.stderr
    assert "of 2 images 1 could not be used" in run.stderr and str(bad) in run.stderr


def test_mount_refuses_measured_trees_that_may_be_one(bolectl, drive):
    run = bolectl("calib", "mount", "--camera", drive / "camera.toml", "--tree", "179,3", "--tree", "-179,3",
                  drive)
    assert run.returncode == 2 and run.stdout == ""
    assert "--tree" in run.stderr and run.stderr.count("\n") == 1


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
    (["mount", "--camera", "{camera}", "/nonexistent.jpg"], "/nonexistent.jpg"),
    (["mount", "--camera", "{camera}", 300 * "n"], "nnn"),
])
def test_wrong_usage_of_calib_is_one_line_and_exit_code_2(bolectl, drive, tmp_path, arguments, named):
    run = bolectl("calib", *[text.format(camera=drive / "camera.toml", empty=tmp_path)
                             for text in arguments])
    assert run.returncode == 2 and run.stdout == ""
    assert named in run.stderr and run.stderr.count("\n") == 1
