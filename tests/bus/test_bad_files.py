"""Frames and truths that are missing, damaged or of another camera, as bolectl tells of them."""

import json

import pytest


def cut(file):
    whole = file.read_bytes()
    return whole[: len(whole) // 2]


def damaged(file):
    whole = file.read_bytes()
    middle = len(whole) // 2
    return whole[:middle] + bytes(~byte & 0xFF for byte in whole[middle : middle + 4]) + whole[middle + 4 :]


# What each makes of the absent `path`, given a drive.
BAD_FRAMES = {
    "missing.jpg": lambda path, drive: None,
    "cut.jpg": lambda path, drive: path.write_bytes(cut(drive / "frame_000000.jpg")),
    "cut.png": lambda path, drive: path.write_bytes(cut(drive / "mask.png")),
    "damaged.png": lambda path, drive: path.write_bytes(damaged(drive / "mask.png")),
    "no_image.png": lambda path, drive: path.write_text("leaves and needles\n"),
    "empty.jpg": lambda path, drive: path.write_bytes(b""),
    "other_size.pgm": lambda path, drive: path.write_bytes(b"P5 64 48 255\n" + bytes(64 * 48)),
    "folder.jpg": lambda path, drive: path.mkdir(),
    "unreadable.jpg": lambda path, drive: path.symlink_to(path),  # for root too
}


@pytest.fixture(params=BAD_FRAMES)
def bad_frame(request, drive, tmp_path):
    path = tmp_path / request.param
    BAD_FRAMES[request.param](path, drive)
    return path


def assert_refused(run, *named, code=2):
    assert run.returncode == code
    assert run.stderr.startswith("bolectl: ") and run.stderr.count("\n") == 1, run.stderr
    for name in named:
        assert str(name) in run.stderr


def test_detect_names_a_bad_image_and_goes_on_with_the_others(bolectl, drive, bad_frame):
    good = [drive / "frame_000000.jpg", drive / "frame_000001.jpg"]
    run = bolectl("detect", "--camera", drive / "camera.toml", good[0], bad_frame, good[1])
    assert_refused(run, bad_frame, code=1)
    before, bad, after = map(json.loads, run.stdout.splitlines())
    assert before["file"] == good[0].name and "trees" in before
    assert bad["file"] == bad_frame.name and bad["error"] in run.stderr
    assert after["file"] == good[1].name and "trees" in after


def test_detect_counts_bad_images_beyond_the_first(bolectl, drive, tmp_path):
    missing = [tmp_path / name for name in ("a.jpg", "b.jpg", "c.jpg")]
    run = bolectl("detect", "--camera", drive / "camera.toml", *missing)
    assert_refused(run, missing[0], "bad images in all: 3", code=1)
    assert [json.loads(line)["file"] for line in run.stdout.splitlines()] == ["a.jpg", "b.jpg",
                                                                              "c.jpg"]


def test_detect_does_not_blame_the_image_for_pictures_that_cannot_be_written(bolectl, drive):
    run = bolectl("detect", "--camera", drive / "camera.toml", "--annotate", drive / "camera.toml",
                  drive / "frame_000000.jpg")
    assert_refused(run, "--annotate", "camera.toml")
    assert "frame_000000" not in run.stderr and run.stdout == ""


def test_eval_refuses_a_folder_of_plots_before_it_works(bolectl, drive):
    run = bolectl("eval", "--camera", drive / "camera.toml", "--truth", drive / "truth.json", "--plots",
                  drive / "truth.json", drive)
    assert_refused(run, "--plots", "truth.json", "give a folder")
    assert run.stdout == ""


def test_eval_names_a_bad_frame(bolectl, drive, bad_frame):
    truth = json.loads((drive / "truth.json").read_text())
    truth["frames"] = truth["frames"][:1]
    truth["frames"][0]["file"] = bad_frame.name
    file = bad_frame.parent / "truth.json"
    file.write_text(json.dumps(truth))
    run = bolectl("eval", "--camera", drive / "camera.toml", "--truth", file, bad_frame.parent)
    assert_refused(run, bad_frame)
    assert run.stdout == ""


def without(key, inside):
    def drop(truth):
        del inside(truth)[key]

    return drop


def a_tree(truth):
    return next(frame["trees"][0] for frame in truth["frames"] if frame["trees"])


@pytest.mark.parametrize("damage, named", [
    (without("frames", lambda truth: truth), "'frames'"),
    (without("file", lambda truth: truth["frames"][2]), "frames[2]: key 'file'"),
    (without("trees", lambda truth: truth["frames"][0]), "frames[0]: key 'trees'"),
    (without("bearing", a_tree), "'bearing'"),
    (lambda truth: a_tree(truth).update(diameter="thick"), "must be number"),
    (lambda truth: truth.update(frames=[]), "frames: is empty"),
])
def test_eval_says_what_a_truth_lacks(bolectl, drive, tmp_path, damage, named):
    truth = json.loads((drive / "truth.json").read_text())
    damage(truth)
    file = tmp_path / "truth.json"
    file.write_text(json.dumps(truth))
    assert_refused(bolectl("eval", "--camera", drive / "camera.toml", "--truth", file, drive),
                   file, named)


@pytest.mark.parametrize("text", ["", "hello", "[1]", '{"frames": 3}', '{"frames": ['])
def test_eval_refuses_what_is_no_truth(bolectl, drive, tmp_path, text):
    file = tmp_path / "truth.json"
    file.write_text(text)
    assert_refused(bolectl("eval", "--camera", drive / "camera.toml", "--truth", file, drive), file)


def test_eval_names_a_truth_or_a_camera_that_is_missing(bolectl, drive, tmp_path):
    missing = tmp_path / "missing"
    camera, truth = drive / "camera.toml", drive / "truth.json"
    assert_refused(bolectl("eval", "--camera", camera, "--truth", missing, drive), missing)
    assert_refused(bolectl("eval", "--camera", missing, "--truth", truth, drive), missing)
    assert_refused(bolectl("eval", "--camera", camera, "--truth", truth, missing), missing)
