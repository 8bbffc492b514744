"""A drive through a wood, seen by a kernel camera: the lists agree with what was rendered."""

from rig import frames, truth
from rig.appliance import Boled, Listener
from rig.camera import Camera
from rig.replay import NO_TRACKS, replay
from rig.wait import wait_until

SMOKE = False
TIME_LIMIT_S = 180
SIZE = (640, 480)
LEAST_F1 = 0.5
MOST_BELOW_REPLAY = 0.05


def run():
    folder = frames.drive_folder()
    true_trees = truth.read(folder)
    replayed = replay(folder, SIZE)
    lists = live_lists(frames.recording(folder, "YUYV", SIZE), len(true_trees))
    pictures = [one["sensor_seq"] % len(true_trees) for one in lists]
    of_camera = truth.f1((true_trees[picture], one["trees"])
                         for picture, one in zip(pictures, lists))
    of_replay = truth.f1((true_trees[picture], replayed[picture]["trees"]) for picture in pictures)
    figures = f"{len(lists)} lists, F1 {of_camera:.2f}, of the replay {of_replay:.2f}"
    assert of_camera >= max(LEAST_F1, of_replay - MOST_BELOW_REPLAY), figures
    return figures


def live_lists(mode, picture_count):
    """Lists from the camera, until half of the pictures had one: a busy machine leaves many out."""
    with Camera([mode], rates=(5,)) as camera, Listener() as listener:
        camera.plug()
        with Boled(f"v4l2:{camera.link}", SIZE, NO_TRACKS):
            def enough():
                lists = listener.lists()
                seen = {one["sensor_seq"] % picture_count for one in lists}
                return lists if len(seen) >= picture_count / 2 else None

            return wait_until(enough, 90, "lists of half the pictures")
