"""What the same frames give without a kernel: the yardstick for what comes out of a camera."""

import json

from rig import frames
from rig.appliance import Boled
from rig.wait import expect

# Each picture by itself: tracks would depend on when frames come, which no camera repeats.
NO_TRACKS = "detect.track=false"


def replayed_lists(fourcc, size):
    """boled's lists for the rendered pictures in this format."""
    return replay(frames.rendered_folder(fourcc, size), size)


def replay(folder, size):
    """boled's lists for the pictures of a folder."""
    boled = Boled(f"replay:{folder}", size, "source.pace=lockstep", NO_TRACKS, publish="jsonl:-",
                  name="replay")
    expect(boled.wait(60), 0, "exit status of the replay")
    return [json.loads(line) for line in boled.stdout.since()]


def expect_same_trees(lists, replayed, what):
    """A camera shows its pictures over and over, so the driver's count tells which one a list is
    of. Returns the number of trees."""
    assert replayed, "the replay gave no lists"
    for one in lists:
        picture = one["sensor_seq"] % len(replayed)
        expect(one["trees"], replayed[picture]["trees"], f"{what}: trees of picture {picture}")
        expect(one["config_crc"], replayed[picture]["config_crc"], f"{what}: config_crc")
    return sum(len(one["trees"]) for one in lists)
