#!/usr/bin/env python3
"""Trains the networks over features on what dump_candidates wrote.

usage: train.py --out src/detect [--only weights|glance_weights] [DUMP...]

Without a dump it writes networks that know nothing, for changed features to be built with.

The one for a glance has one small layer and is shown all but what is about the foot. The other has
two hidden layers of leaky units over the standardised features. Samples are shown mirrored half of
the time. Gaussian noise on the inputs keeps the network from leaning on details that only the
simulator has; the last epochs go without, so that the deviations are those of clean inputs.
"""
import math

import numpy as np
import torch
from torch import nn

from detector_source import LEAK, biases, constant, matrix, numbers, parser
from likelihood import OUTPUTS, loss, report
from samples import (ACROSS, FEATURES, FOOT, GRID, HEIGHTS, LIMIT, MIRRORED_HEAD, ROWS,
                     Standardised, load, mirror, of_held_out_frames, weighed)

HIDDEN, GLANCE_HIDDEN = (192, 48), (48,)
SPREAD_NUMBER = 2  # of the grid, log brightness
LEAST_SPREAD = constant("kLeastSpread", "src/detect/contrast/bands.h")
LEAST_ROW_SPREAD = constant("kLeastSpread", "src/detect/network/row_contrasts.cpp")
EPOCHS, LAST_EPOCHS, BATCH, DECAY, NOISE = 14, 2, 2048, 1e-4, 0.1
RATE, LAST_RATE, WARM_UP = 3e-3, 1e-5, 200  # the learning rate's peak and end; steps to the peak


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


def network(inputs, hidden):
    """Linear layers with leaky units between; the weights' variance keeps that of what they sum."""
    sizes = (inputs, *hidden, OUTPUTS)
    layers = []
    for n, m in zip(sizes, sizes[1:]):
        linear = nn.Linear(n, m)
        nn.init.kaiming_normal_(linear.weight, nonlinearity="relu")
        nn.init.zeros_(linear.bias)
        layers += [linear, nn.LeakyReLU(LEAK)]
    return nn.Sequential(*layers[:-1])


def rate(step, steps):
    """The learning rate, as a share of the peak: up along a line, down along half a cosine."""
    if step < WARM_UP:
        return step / WARM_UP
    fallen = (1 - math.cos(math.pi * (step - WARM_UP) / (steps - WARM_UP))) / 2
    return 1 + (LAST_RATE / RATE - 1) * fallen


def train(net, head, z, mirror, loss=loss, batch=BATCH, decay=DECAY, noise=NOISE):
    head, z, mirrored = map(torch.from_numpy, (head, z, MIRRORED_HEAD))
    source, sign = map(torch.from_numpy, mirror)
    batches = len(z) // batch
    steps = (EPOCHS + LAST_EPOCHS) * batches
    if steps <= WARM_UP:
        raise SystemExit(f"train.py: {len(z)} samples are too few: draw more frames")
    optimiser = torch.optim.AdamW(net.parameters(), RATE, weight_decay=decay, fused=True)
    schedule = torch.optim.lr_scheduler.LambdaLR(optimiser, lambda step: rate(step, steps))
    for epoch in range(EPOCHS + LAST_EPOCHS):
        grain = noise if epoch < EPOCHS else 0.0
        for chosen in torch.randperm(len(z))[:batches * batch].view(batches, batch):
            seen, truth = z[chosen].float(), head[chosen]
            turned = torch.rand(batch) < 0.5
            seen[turned] = seen[turned][:, source] * sign
            truth[turned] *= mirrored
            seen += grain * torch.randn_like(seen)
            optimiser.zero_grad()
            loss(net(seen), truth).backward()
            optimiser.step()
            schedule.step()
    return net


def write(standardised, net, path):
    layers = [layer for layer in net if isinstance(layer, nn.Linear)]
    units = ("kFirst", "kSecond")[:len(layers) - 1] + ("kOutput",)
    sizes = ("kInputs", *units[:-1], "kOutputs")
    counts = (len(standardised.mean), *(layer.out_features for layer in layers))
    with open(path, "w") as out:
        out.write(f"""// Written by tools/train/train.py.
namespace {path.stem} {{
constexpr int {", ".join(f"{size} = {count}" for size, count in zip(sizes, counts))};
constexpr float kLimit = {LIMIT}F;
constexpr float kMean[kInputs] = {{{numbers(standardised.mean)}}};
constexpr float kScale[kInputs] = {{{numbers(standardised.scale)}}};
""")
        for unit, layer in zip(units, layers):
            out.write(biases(unit[1:], layer.bias.detach().numpy()))
        for unit, layer in zip(units, layers):
            out.write(matrix(f"kTo{unit[1:]}", layer.weight.detach().numpy().T))
        out.write(f"}}  // namespace {path.stem}\n")


def fit(head, x, shown, mirror, hidden, path):
    """Trains a network on what it is `shown` of the features, says how good it is, writes its
    weights."""
    held_out = of_held_out_frames(head)
    tested = head[held_out], x[held_out]
    head, x = head[~held_out], x[~held_out]
    standardised = Standardised(shown(x[::8]), mirror)
    net = train(network(len(standardised.mean), hidden), weighed(head, x), standardised(shown(x)),
                mirror)
    with torch.no_grad():
        out = net(torch.from_numpy(standardised(shown(tested[1]))).float())
    report(out.numpy(), tested[0])
    write(standardised, net, path)


def main():
    options = parser(__doc__, "look_weights.inc and glance_weights.inc")
    options.add_argument("--only", choices=["look_weights", "glance_weights"])
    arguments = options.parse_args()
    networks = {"look_weights": (lambda x: x, mirror(), HIDDEN),
                "glance_weights": (at_a_glance, mirror_at_a_glance(), GLANCE_HIDDEN)}
    if arguments.only:
        networks = {arguments.only: networks[arguments.only]}
    if arguments.dumps:
        head, x, _ = load(arguments.dumps)
    for name, (shown, mirror_of, hidden) in networks.items():
        torch.manual_seed(0)  # for each, so that alone it becomes what it becomes beside the other
        path = arguments.out / f"{name}.inc"
        if arguments.dumps:
            fit(head, x, shown, mirror_of, hidden, path)
        else:
            nothing = shown(np.zeros((1, FEATURES), np.float32))
            write(Standardised(nothing, mirror_of), network(nothing.shape[1], hidden), path)


if __name__ == "__main__":
    main()
