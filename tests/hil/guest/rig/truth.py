"""How well lists agree with the truth that was rendered with their pictures."""

import json
import math


def read(folder):
    """The trees of each picture of a rendered folder."""
    frames = json.loads((folder / "truth.json").read_text())["frames"]
    return [frame["trees"] for frame in frames]


def f1(pairs):
    """F1 over (trees of the truth, trees of a list), by the rules of src/evaluate/matching.h: trees
    of 0.2 to 0.8 m in 1 to 8 m of which half is visible should be found; others are passed over."""
    hits = false_alarms = wanted = 0
    for true_trees, found in pairs:
        left = list(true_trees)
        wanted += sum(map(_eligible, left))
        for tree in sorted(found, key=lambda tree: -tree["score"]):
            near = [one for one in left if _within_gate(one, tree)]
            if near:
                best = min(near, key=lambda one: (not _eligible(one), _distance(one, tree)))
                left.remove(best)
                hits += _eligible(best)
            elif 1 <= tree["range"] <= 8:
                false_alarms += 1
    assert wanted, "the pictures show no tree that should be found"
    return 2 * hits / (hits + false_alarms + wanted)


def _eligible(tree):
    return 1 <= tree["range"] <= 8 and 0.2 <= tree["diameter"] <= 0.8 and tree["visible"] >= 0.5


def _within_gate(true, tree):
    turn = abs(math.remainder(tree["bearing"] - true["bearing"], 2 * math.pi))
    half_width = math.asin(min(0.99, true["diameter"] / 2 / true["range"]))
    return (turn <= max(math.radians(1.5), half_width) and
            _distance(true, tree) <= max(1, true["range"] / 4))


def _distance(one, other):
    return math.dist(*((tree["range"] * math.cos(tree["bearing"]),
                        tree["range"] * math.sin(tree["bearing"])) for tree in (one, other)))
