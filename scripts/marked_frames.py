"""Frames with truth that the figures are read on, and what bolectl eval makes of them. Used by
scripts/calibration, scripts/degraded, scripts/held_out, scripts/photographs, scripts/robustness and
scripts/tracking."""
import json
import math
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAMS = ROOT / "build/release/firmware_app"
BOLECTL = PROGRAMS / "bolectl"
SHARED = pathlib.Path(os.environ.get("BOLE_SHARED_DIR", ROOT.parent / "shared")) / "data"
NEAR_TREES = "range_m = [1, 8]\ndiameter_m = [0.2, 0.8]"
ALL_TREES = "range_m = [1, 40]\ndiameter_m = [0.1, 1.2]"
# Training draws its cameras and woods from seeds of 1,000,003 on; nothing was ever fitted to these.
HELD_OUT_CAMERAS = [900001, 900002, 900003]


def run(*command):
    """The command's standard output; ends the script with what the command says when it fails."""
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(done.args)}\n{done.stderr}")
    return done.stdout


def build(*targets):
    run("cmake", "--preset", "release", "-S", ROOT)
    run("cmake", "--build", ROOT / "build/release", "--target", *targets)


def evaluate(camera, folder, images=None):
    """The product mode's figures; `images`: folder of the frames where it is not the truth's."""
    return json.loads(run(BOLECTL, "eval", "--json", "--camera", camera, "--truth",
                          folder / "truth.json", images or folder))["bole"]


def apart(tree, other):
    """Metres between them on the ground."""
    return math.dist(*([t["range"] * math.cos(t["bearing"]), t["range"] * math.sin(t["bearing"])]
                       for t in (tree, other)))


def matches(found, tree):
    """Whether a detection may be of that tree, by the gate of tools/score.py."""
    turn = abs(math.remainder(found["bearing"] - tree["bearing"], 2 * math.pi))
    half = math.asin(min(0.99, tree["diameter"] / 2 / tree["range"]))
    return turn <= max(math.radians(1.5), half) and apart(found, tree) <= max(1, tree["range"] / 4)


def held_out(folder, seed, preset, frames):
    """Folder of `frames` frames, each of a wood of its own, through the invented camera of `seed`;
    rendered when it is not there."""
    target = folder / f"{preset}_{seed}_{frames}"
    if (target / "truth.json").exists():
        return target
    parts = []
    for k in range(frames):
        part = folder / "parts" / target.name / str(k)
        # The first frame's seed invents the camera; the others see through it.
        camera = "invented" if k == 0 else parts[0] / "camera.toml"
        run(BOLECTL, "sim", "--out", part, "--frames", 1, "--seed", seed + 1000 * k, "--camera",
            camera, "--preset", preset)
        parts.append(part)
    target.mkdir(parents=True)
    for name in ("camera.toml", "calib_results.txt", "mask.png"):
        (parts[0] / name).rename(target / name)
    truth = None
    for k, part in enumerate(parts):
        frame_truth = json.loads((part / "truth.json").read_text())
        frame = frame_truth["frames"][0] | {"file": f"frame_{k:04}.jpg", "world": k}
        (part / "frame_000000.jpg").rename(target / frame["file"])
        if truth is None:
            truth = frame_truth | {"frames": []}
        truth["frames"].append(frame)
    (target / "truth.json").write_text(json.dumps(truth))
    return target


def drive(folder, seed, frames, *options):
    """A drive through the invented camera of `seed`, rendered when it is not there."""
    target = folder / "_".join(["drive", str(seed), str(frames), *options[1:]])
    if not (target / "truth.json").exists():
        run(BOLECTL, "sim", "--out", target, "--frames", frames, "--seed", seed, "--camera",
            "invented", *options)
    return target


def shared_camera(data, folder, search):
    """camera.toml, in `folder`, for a folder of ../shared/data; the mount as in truth.json."""
    truth = json.loads((data / "truth.json").read_text())
    sides = truth["mount"]
    angles = truth if "height_m" in truth else sides
    camera = folder / f"{data.name}.toml"
    camera.write_text(
        f'[camera]\nmodel = "ocam"\ncalibration = "{data / "calib_results.txt"}"\n'
        f'mask = "{data / "mask.png"}"\n[mount]\n'
        + "".join(f'{key} = "{sides[key]}"\n' for key in ("forward", "left"))
        + "".join(f"{key} = {angles[key]}\n"
                  for key in ("height_m", "roll_deg", "pitch_deg", "yaw_deg"))
        + f"[search]\n{search}\n")
    return camera


def print_table(head, rows):
    print("| " + " | ".join(head) + " |")
    print("|---|" + "---:|" * (len(head) - 1))
    for row in rows:
        print("| " + " | ".join(row) + " |")
