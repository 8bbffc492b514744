"""OpenCV's omnidirectional cameras from camera.toml to scored trees: frames rendered through one are
read back, and the trees in them found, whichever way it is mounted."""

import json
import pathlib

import pytest

MATRIX = """{name}: !!opencv-matrix
   rows: {rows}
   cols: {cols}
   dt: d
   data: [ {data} ]
"""


def calibration(focal, distortion, last, size=""):
    numbers = [focal, 0, 401.5, 0, focal, 396, 0, 0, 1]
    return ("%YAML:1.0\n---\n" + size
            + MATRIX.format(name="camera_matrix", rows=3, cols=3, data=", ".join(map(str, numbers)))
            + MATRIX.format(name="distortion_coefficients", rows=4, cols=1,
                            data=", ".join(map(str, distortion))) + last + "\n")


FISHEYE = ("fisheye", calibration(205, [0.03, -0.01, 0.003, -0.0005], "fisheye_model: 1",
                                  "image_width: 800\nimage_height: 800\n"), "")
# OpenCV's sample program for these leaves the size out.
OMNIDIR = ("omnidir", calibration(300, [-0.02, 0.004, 0.0005, -0.0003], "xi: 1.1"),
           "width = 800\nheight = 800")
MOUNTS = {
    "down": 'forward = "image up"\nleft = "image left"\ncentre = "down"\nroll_deg = 1\npitch_deg = -1.5',
    "mirror": 'forward = "image down"\nleft = "image left"\ncentre = "down"\nyaw_deg = 20',
    "up": 'forward = "image right"\nleft = "image down"\ncentre = "up"\npitch_deg = 2',
    "ahead": 'forward = "image up"\nleft = "image left"\ncentre = "down"\npitch_deg = -87',
}


@pytest.fixture(params=[(FISHEYE, mount) for mount in ("down", "up", "ahead")]
                + [(OMNIDIR, mount) for mount in ("mirror", "up")],
                ids=lambda param: f"{param[0][0]}-{param[1]}")
def camera(request, tmp_path):
    (model, yaml, size), mount = request.param
    (tmp_path / "calibration.yml").write_text(yaml)
    file = tmp_path / "camera.toml"
    file.write_text(f"""[camera]
model = "{model}"
calibration = "calibration.yml"
{size}
[mount]
height_m = 1.1
{MOUNTS[mount]}
[panorama]
columns = 1440
elevation_top_deg = 20
range_min_m = 1
""")
    return model, file


def test_trees_rendered_through_a_camera_are_found_through_it(bolectl, camera, tmp_path):
    model, file = camera
    checked = json.loads(bolectl("calib", "check", "--json", "--camera", file).stdout)
    assert checked["model"] == model
    assert checked["there_and_back"]["most_px"] < 1e-6
    assert not [warning for warning in checked["warnings"] if "mount" in warning or "bearing" in warning]
    drive = tmp_path / "drive"
    run = bolectl("sim", "--out", drive, "--frames", "5", "--seed", "3", "--camera", file)
    assert run.returncode == 0, run.stderr
    scored = bolectl("eval", "--json", "--camera", drive / "camera.toml", "--truth",
                     drive / "truth.json", drive)
    assert scored.returncode == 0, scored.stderr
    found = json.loads(scored.stdout)["bole"]
    assert found["trees"] >= 5 and found["f1"] > 0.7 and found["dp_m"] < 0.4


def test_a_table_is_of_the_calibration_it_was_built_from(bolectl, camera, tmp_path):
    model, file = camera
    table = tmp_path / "table.lut"
    assert bolectl("lut", "build", "--camera", file, "--out", table).returncode == 0
    info = ["lut", "info", "--camera", file, table]
    assert bolectl(*info).returncode == 0
    yaml = file.with_name("calibration.yml")
    yaml.write_text(yaml.read_text().replace("401.5", "402.5"))
    refused = bolectl(*info)
    assert refused.returncode == 2 and "another camera" in refused.stderr


def test_a_damaged_calibration_is_one_line_and_exit_code_2(bolectl, camera):
    model, file = camera
    yaml = file.with_name("calibration.yml")
    for damaged in (yaml.read_text().replace("0, 401.5", "0, .nan"), "", "data: [",
                    yaml.read_text().replace("distortion_coefficients", "D")):
        yaml.write_text(damaged)
        run = bolectl("detect", "--camera", file, "frame.png")
        assert run.returncode == 2 and run.stdout == ""
        assert "calibration.yml" in run.stderr and run.stderr.count("\n") == 1


@pytest.mark.parametrize("example", ["example", "fisheye", "pinhole"])
def test_calib_check_has_nothing_against_the_examples(bolectl, example):
    camera = pathlib.Path(__file__).parents[2] / "calib" / example / "camera.toml"
    assert json.loads(bolectl("calib", "check", "--json", "--camera", camera).stdout)["warnings"] == []
