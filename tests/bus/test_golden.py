"""The golden bytes, read by the code that lcm-gen makes for Python."""

import pathlib

import pytest

GOLDEN = pathlib.Path(__file__).resolve().parent.parent / "golden/publish"


def trees(types, name):
    return types.tree_list_t.decode((GOLDEN / name).read_bytes())


@pytest.mark.parametrize("name, count", [("no_tree", 0), ("one_tree", 1), ("most_trees", 32)])
def test_lists(types, name, count):
    message = trees(types, f"{name}.bin")
    assert (message.utime, message.capture_mono_ns) == (1_700_000_000_123_456, 1_234_567_890_123)
    assert (message.publish_mono_ns, message.seq, message.sensor_seq) == (1_234_570_000_000, 41, 43)
    assert message.config_crc & 0xFFFFFFFF == 0xDEADBEEF
    assert (message.source, message.flags, message.camera) == (0, 0, "front")
    assert message.num_trees == count == len(message.trees)
    for k, tree in enumerate(message.trees):
        assert (tree.id, tree.bearing, tree.range) == (k, -3 + k / 8, 1 + k / 4)
        assert (tree.diameter, tree.score) == (0.25 + k / 64, 1 - k / 64)
        assert (tree.bearing_sigma, tree.range_sigma, tree.diameter_sigma) == (1 / 64, 1 / 8, 1 / 16)
        assert (tree.base_elevation, tree.angular_width) == (-0.5 + k / 128, 0.25)


def test_extremes(types):
    message = trees(types, "extreme.bin")
    assert (message.utime, message.capture_mono_ns) == (-(2**63), 2**63 - 1)
    assert (message.publish_mono_ns, message.sensor_seq) == (-1, 2**63 - 1)
    assert message.config_crc == -1
    assert message.flags == types.tree_list_t.FLAG_DEGRADED | types.tree_list_t.FLAG_REPLAY
    assert message.camera == "c" * 16
    tree = message.trees[0]
    largest = (2 - 2**-23) * 2.0**127
    assert (tree.id, tree.bearing, tree.range) == (-(2**31), -largest, largest)
    assert (tree.diameter, tree.score, tree.range_sigma) == (2.0**-126, 2.0**-149, 2.0**-23)


def test_status(types):
    status = types.status_t.decode((GOLDEN / "status.bin").read_bytes())
    assert status.state == types.status_t.STATE_NO_CAMERA
    assert (status.state_reason, status.degraded_reason) == ("unplugged", "dark")
    assert status.degraded and status.last_error == "no multicast route"
    assert [(drop.name, drop.count) for drop in status.drops] == [("overwritten", 2), ("bad_frame", 0)]
    assert [(event.name, event.count) for event in status.camera_events] == [("losses", 3)]
    (bus,) = status.buses
    assert (bus.name, bus.healthy, bus.published, bus.overwritten) == ("lcm", True, 147, 1)
    assert list(bus.handover_histogram) == list(range(20))
    assert bus.handover_p99_us == 120
