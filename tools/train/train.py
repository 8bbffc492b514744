#!/usr/bin/env python3
"""Trains the detector's networks on what dump_candidates wrote.

usage: train.py --out src/detect [--only weights|glance_weights] [DUMP...]

Without a dump it writes networks that know nothing, for changed features to be built with.

The one for a glance has one small layer and is shown all but what is about the foot. The other has
two hidden layers of leaky units over the standardised features, and seven outputs: the logit of
'this is a trunk', the shifts of middle, log width and foot that lead to it, and the logarithms of
their standard deviations. Samples are shown mirrored half of the time. Gaussian noise on the
inputs keeps the network from leaning on details that only the simulator has; the last epochs go
without, so that the deviations are those of clean inputs. Every eighth frame is held out and only
reported on.
"""
import argparse
import pathlib
import re

import jax
import jax.numpy as jnp
import numpy as np
import optax

ROOT = pathlib.Path(__file__).resolve().parents[2]


def constant(name, file):
    """What the detector's own source says."""
    return float(re.search(rf"\b{name} = ([\d.]+)F?;", (ROOT / file).read_text())[1])


HEAD = int(constant("kHead", "tools/train/dump_candidates.cpp"))
HEIGHTS, ACROSS, FOOT_ROWS, STRIPS, NUMBERS, ROW_NUMBERS = (
    int(constant(name, "src/detect/trunk_features.h"))
    for name in ("kHeights", "kAcross", "kFootRows", "kStrips", "kNumbers", "kRowNumbers"))
GRID = HEIGHTS * ACROSS
ROWS = GRID + FOOT_ROWS * STRIPS + NUMBERS  # where the rows' numbers begin
FEATURES = ROWS + ROW_NUMBERS * HEIGHTS + HEIGHTS
LEFT_EDGE, RIGHT_EDGE = (slice(ROWS + k * HEIGHTS, ROWS + (k + 1) * HEIGHTS) for k in (2, 3))
LEFT_RIGHT_NUMBERS = [(5, 6), (8, 9), (13, 14)]  # that change places in a mirror
SIDEWAYS_NUMBERS = [18]  # that change sign in a mirror
POLARITY_NUMBER = 3  # 1 dark, -1 bright
HIDDEN, OUTPUTS = (192, 48), 7
LEAK = constant("kLeak", "src/detect/dense_layer.h")
FOOT = slice(GRID, GRID + FOOT_ROWS * STRIPS)
GLANCE_HIDDEN = (48,)
SPREAD_NUMBER = 2  # of the grid, log brightness
LEAST_SPREAD = constant("kLeastSpread", "src/detect/trunk_features.cpp")
LEAST_ROW_SPREAD = constant("kLeastSpread", "src/detect/row_contrasts.cpp")
LIMIT = 4.0  # of a standardised feature
MOST_WEIGHT = 8  # of a sample: it stands for others that were not kept
SHIFTS_WEIGHT = 0.12  # of their likelihood beside the logit's
LOG_SIGMAS, LARGE_ERROR = (-4.5, 3), 3.0  # of the shifts; the error in sigmas
BRIGHT_WEIGHT = 2.5  # of bright trunks: they are the fewer, but as good to run into
EPOCHS, LAST_EPOCHS, BATCH, RATE, DECAY, NOISE = 14, 2, 2048, 3e-3, 1e-4, 0.1


def load(paths):
    heads, features = [], []
    for path in paths:
        rows = np.fromfile(path, np.float32).reshape(-1, HEAD + FEATURES)
        heads.append(rows[:, :HEAD].copy())
        features.append(rows[:, HEAD:].astype(np.float16))  # memory is what runs out
    return np.concatenate(heads), np.concatenate(features)


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


MIRRORED_HEAD = np.float32([1, 1, -1, 1, 1, 1])  # the centre's shift


def at_a_glance(x):
    """What the network for a glance is shown: no foot, and rows of cells as they were before each
    was made as strong in contrast as the others."""
    x = x.astype(np.float32)
    unit = np.maximum(x[:, FOOT.stop + SPREAD_NUMBER], LEAST_SPREAD)[:, None]
    mean, log_spread = (x[:, ROWS + k * HEIGHTS:ROWS + (k + 1) * HEIGHTS] for k in (0, 1))
    full = np.maximum(np.exp(log_spread), LEAST_ROW_SPREAD) / unit
    grid = x[:, :GRID].reshape(-1, HEIGHTS, ACROSS) * full[:, :, None] + mean[:, :, None]
    seen = np.concatenate([grid.reshape(-1, GRID), x[:, FOOT.stop:FEATURES - 1]], 1)
    return seen.astype(np.float16)


def mirror_at_a_glance():
    source, sign = mirror()
    shown = np.r_[:GRID, FOOT.stop:FEATURES - 1]
    return np.searchsorted(shown, source[shown]), sign[shown]


def first_weights(random, inputs, hidden):
    sizes = (inputs, *hidden, OUTPUTS)
    layers = [(random.normal(0, np.sqrt(2 / n), (n, m)), np.zeros(m))
              for n, m in zip(sizes, sizes[1:])]
    return jax.tree.map(np.float32, layers)


def forward(layers, z):
    for weights, bias in layers[:-1]:
        z = jax.nn.leaky_relu(z @ weights + bias, LEAK)
    return z @ layers[-1][0] + layers[-1][1]


def loss(layers, z, head):
    out = forward(layers, z)
    label, shifts, weight = head[:, 1], head[:, 2:5], head[:, 5]
    logit = optax.sigmoid_binary_cross_entropy(out[:, 0], label)
    # The shifts' negative log likelihood; large errors pull like a Laplacian's.
    log_sigma = out[:, 4:].clip(*LOG_SIGMAS)
    error = (out[:, 1:4] - shifts) * jnp.exp(-log_sigma)
    shift = (optax.huber_loss(error, delta=LARGE_ERROR) + log_sigma).sum(1)
    return (weight * (logit + SHIFTS_WEIGHT * (label == 1) * shift)).mean()


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


def of_held_out_frames(head):
    return head[:, 0].astype(int) % 8 == 0


def weighed(head, x):
    head = head.copy()
    head[:, 5] = np.minimum(head[:, 5], MOST_WEIGHT)
    bright = x[:, GRID + FOOT_ROWS * STRIPS + POLARITY_NUMBER] < 0
    head[bright & (head[:, 1] == 1), 5] *= BRIGHT_WEIGHT
    head[:, 5] /= head[:, 5].mean()
    return head


def train(head, z, hidden, mirror, random):
    source, sign = mirror
    layers = first_weights(random, z.shape[1], hidden)
    steps = len(z) // BATCH
    rate = optax.warmup_cosine_decay_schedule(0, RATE, 200, (EPOCHS + LAST_EPOCHS) * steps, 1e-5)
    optimiser = optax.adamw(rate, weight_decay=DECAY)
    state = optimiser.init(layers)

    @jax.jit
    def step(layers, state, z, head, key, noise):
        for_noise, for_side = jax.random.split(key)
        z = z.astype(jnp.float32)
        turned = jax.random.bernoulli(for_side, 0.5, (len(z), 1))
        z = jnp.where(turned, z[:, source] * sign, z)
        z += noise * jax.random.normal(for_noise, z.shape)
        head = jnp.where(turned, head * MIRRORED_HEAD, head)
        change, state = optimiser.update(jax.grad(loss)(layers, z, head), state, layers)
        return optax.apply_updates(layers, change), state

    key = jax.random.PRNGKey(0)
    for epoch in range(EPOCHS + LAST_EPOCHS):
        noise = NOISE if epoch < EPOCHS else 0.0
        for batch in random.permutation(len(z))[:steps * BATCH].reshape(steps, BATCH):
            key, now = jax.random.split(key)
            layers, state = step(layers, state, z[batch], head[batch], now, noise)
    return jax.tree.map(np.asarray, layers)


def report_outputs(out, head):
    trunk, weight = head[:, 1] == 1, np.minimum(head[:, 5], MOST_WEIGHT)
    log_loss = np.logaddexp(0, np.where(trunk, -out[:, 0], out[:, 0]))
    taken = out[:, 0] > 0
    left = np.median(abs(head[trunk, 2:5] - out[trunk, 1:4]), 0) * 1.48
    print(f"held out: {len(head)} samples, log loss {np.average(log_loss, weights=weight):.4f}, "
          f"recall {taken[trunk].mean():.3f}, "
          f"precision {np.average(trunk[taken], weights=weight[taken]):.3f}, "
          f"left of the shifts {left.round(3)} of {head[trunk, 2:5].std(0).round(3)}")


def numbers(values):
    return ", ".join(np.format_float_positional(v, 6, fractional=False, trim="0") + "F"
                     for v in values)


def matrix(name, values):
    rows = ",\n    ".join("{" + numbers(row) + "}" for row in values)
    return f"constexpr float {name}[{len(values)}][{len(values[0])}] = {{\n    {rows}}};\n"


def bias(name, values):
    return f"constexpr std::array<float, {len(values)}> k{name}Bias = {{{numbers(values)}}};\n"


def write(standardised, layers, path):
    units = ("kFirst", "kSecond")[:len(layers) - 1] + ("kOutput",)
    sizes = ("kInputs", *units[:-1], "kOutputs")
    counts = (len(standardised.mean), *(len(values) for _, values in layers))
    with open(path, "w") as out:
        out.write(f"""// Written by tools/train/train.py.
namespace {path.stem} {{
constexpr int {", ".join(f"{size} = {count}" for size, count in zip(sizes, counts))};
constexpr float kLimit = {LIMIT}F;
constexpr float kMean[kInputs] = {{{numbers(standardised.mean)}}};
constexpr float kScale[kInputs] = {{{numbers(standardised.scale)}}};
""")
        for unit, (_, values) in zip(units, layers):
            out.write(bias(unit[1:], values))
        for unit, (values, _) in zip(units, layers):
            out.write(matrix(f"kTo{unit[1:]}", values))
        out.write(f"}}  // namespace {path.stem}\n")


def fit(head, x, shown, mirror, hidden, path):
    """Trains a network on what it is `shown` of the features, says how good it is, writes its
    weights."""
    held_out = of_held_out_frames(head)
    tested = head[held_out], x[held_out]
    head, x = head[~held_out], x[~held_out]
    standardised = Standardised(shown(x[::8]), mirror)
    layers = train(weighed(head, x), standardised(shown(x)), hidden, mirror,
                   np.random.default_rng(0))
    z = standardised(shown(tested[1])).astype(np.float32)
    report_outputs(np.asarray(forward(layers, z)), tested[0])
    write(standardised, layers, path)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", required=True, type=pathlib.Path,
                        help="the folder of weights.inc and glance_weights.inc")
    parser.add_argument("--only", choices=["weights", "glance_weights"])
    parser.add_argument("dumps", nargs="*")
    arguments = parser.parse_args()
    networks = {"weights": (lambda x: x, mirror(), HIDDEN),
                "glance_weights": (at_a_glance, mirror_at_a_glance(), GLANCE_HIDDEN)}
    if arguments.only:
        networks = {arguments.only: networks[arguments.only]}
    if arguments.dumps:
        head, x = load(arguments.dumps)
    for name, (shown, mirror_of, hidden) in networks.items():
        path = arguments.out / f"{name}.inc"
        if arguments.dumps:
            fit(head, x, shown, mirror_of, hidden, path)
        else:
            nothing = shown(np.zeros((1, FEATURES), np.float32))
            layers = first_weights(np.random.default_rng(0), nothing.shape[1], hidden)
            write(Standardised(nothing, mirror_of), layers, path)


if __name__ == "__main__":
    main()
