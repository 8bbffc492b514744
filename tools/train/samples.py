"""The samples that dump_candidates wrote, and how a network is shown them.

A sample is a head (frame number, label, three shifts to the truth, weight), the features, and for a
close look the bytes of its patches. Every eighth frame is held out and only reported on.
"""
import numpy as np

from detector_source import constant

HEAD = int(constant("kHead", "tools/train/dump_candidates.cpp"))
HEIGHTS, ACROSS, FOOT_ROWS, STRIPS, NUMBERS, ROW_NUMBERS = (
    int(constant(name, "src/detect/network/trunk_features.h"))
    for name in ("kHeights", "kAcross", "kFootRows", "kStrips", "kNumbers", "kRowNumbers"))
GRID = HEIGHTS * ACROSS
FOOT = slice(GRID, GRID + FOOT_ROWS * STRIPS)
ROWS = FOOT.stop + NUMBERS  # where the rows' numbers begin
FEATURES = ROWS + ROW_NUMBERS * HEIGHTS + HEIGHTS
LEFT_EDGE, RIGHT_EDGE = (slice(ROWS + k * HEIGHTS, ROWS + (k + 1) * HEIGHTS) for k in (2, 3))
LEFT_RIGHT_NUMBERS = [(5, 6), (8, 9), (13, 14)]  # that change places in a mirror
SIDEWAYS_NUMBERS = [18]  # that change sign in a mirror
POLARITY_NUMBER = 3  # 1 dark, -1 bright
LIMIT = 4.0  # of a standardised feature
MOST_WEIGHT = 8  # of a sample: it stands for others that were not kept
BRIGHT_WEIGHT = 2.5  # of bright trunks: they are the fewer, but as good to run into


def load(paths, patch_bytes=0):
    """The heads, features and patches of all samples; each has so many bytes of patches."""
    float_bytes = 4 * (HEAD + FEATURES)
    dumps = [np.memmap(path, np.uint8, "r").reshape(-1, float_bytes + patch_bytes)
             for path in paths]
    count = sum(map(len, dumps))
    # Memory is what runs out: halves will do for the features, and all stands there but once.
    head, features, patches = (np.empty((count, width), kind) for width, kind in (
        (HEAD, np.float32), (FEATURES, np.float16), (patch_bytes, np.int8)))
    first = 0
    for dump in dumps:
        for rows in np.array_split(dump, 1 + len(dump) // 65536):
            part = slice(first, first + len(rows))
            floats = np.ascontiguousarray(rows[:, :float_bytes]).view(np.float32)
            head[part], features[part] = np.split(floats, [HEAD], 1)
            patches[part] = rows[:, float_bytes:].view(np.int8)
            first = part.stop
    return head, features, patches


def of_held_out_frames(head):
    return head[:, 0].astype(int) % 8 == 0


def weighed(head, x):
    """The heads with the weights to train by: bounded, more for bright trunks, 1 on average."""
    head = head.copy()
    head[:, 5] = np.minimum(head[:, 5], MOST_WEIGHT)
    bright = x[:, FOOT.stop + POLARITY_NUMBER] < 0
    head[bright & (head[:, 1] == 1), 5] *= BRIGHT_WEIGHT
    head[:, 5] /= head[:, 5].mean()
    return head


MIRRORED_HEAD = np.float32([1, 1, -1, 1, 1, 1])  # the centre's shift


def mirror():
    """Where each feature comes from in a mirror, and its sign there."""
    source, sign = np.arange(FEATURES), np.ones(FEATURES, np.float32)
    source[:GRID] = source[:GRID].reshape(HEIGHTS, ACROSS)[:, ::-1].ravel()
    source[FOOT] = source[FOOT].reshape(FOOT_ROWS, STRIPS)[:, ::-1].ravel()
    for a, b in LEFT_RIGHT_NUMBERS:
        source[FOOT.stop + a], source[FOOT.stop + b] = FOOT.stop + b, FOOT.stop + a
    source[LEFT_EDGE], source[RIGHT_EDGE] = source[RIGHT_EDGE].copy(), source[LEFT_EDGE].copy()
    sign[[FOOT.stop + a for a in SIDEWAYS_NUMBERS]] = -1
    return source, sign


class Standardised:
    """Features as the network sees them."""

    def __init__(self, x, mirror):
        source, sign = mirror
        x = x.astype(np.float32)
        x = np.concatenate([x, x[:, source] * sign])
        self.mean, self.scale = x.mean(0), 1 / (x.std(0) + 1e-3)

    def __call__(self, x):
        parts = np.array_split(x, 1 + len(x) // 65536)
        return np.concatenate([((part - self.mean) * self.scale).clip(-LIMIT, LIMIT)
                               .astype(np.float16) for part in parts])
