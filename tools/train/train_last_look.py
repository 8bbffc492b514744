#!/usr/bin/env python3
"""Trains the network for a last look on what `dump_candidates OUT last` wrote.

usage: train_last_look.py --out src/detect [DUMP...]

Without a dump it writes a network that knows nothing, to be built with. It is trained as the one
over features is, but of trunks only and by the shifts alone; it sees the features and the patch
about the foot. Its deviations are those that 95 % of the errors of frames it was not shown lie
within twice. What it says of the inputs of the detector's own test goes to the golden file of that.
"""
import numpy as np
import torch
from torch import nn

from detector_source import LEAK, constant, parser, waves, write_golden
from likelihood import OUTPUTS, errors, left_of_shifts, shifts_loss
from samples import FEATURES, Standardised, load, mirror, of_held_out_frames, weighed
from train import train, write

PATCH_ROWS, PATCH_ACROSS = (int(constant(name, "src/detect/network/foot_patch.h"))
                            for name in ("kRows", "kAcross"))
PATCH = PATCH_ROWS * PATCH_ACROSS
FIRST, SECOND = 96, 48
BATCH, DECAY, NOISE = 1024, 1e-2, 0.15


def mirror_with_foot():
    source, sign = mirror()
    patch = np.arange(PATCH).reshape(PATCH_ROWS, PATCH_ACROSS)[:, ::-1].ravel()
    return np.r_[source, FEATURES + patch], np.r_[sign, np.ones(PATCH, np.float32)]


def network():
    """The layers start smaller than those of train.py do: of so few samples they learn the more."""
    net = nn.Sequential(nn.Linear(FEATURES + PATCH, FIRST), nn.LeakyReLU(LEAK),
                        nn.Linear(FIRST, SECOND), nn.LeakyReLU(LEAK), nn.Linear(SECOND, OUTPUTS))
    with torch.no_grad():  # whether it is a trunk is not asked, and not answered
        net[-1].weight[0] = 0
        net[-1].bias[0] = 0
    return net


@torch.no_grad()
def outputs(net, standardised, x):
    return torch.cat([net(torch.from_numpy(standardised(part)).float())
                      for part in np.array_split(x, 1 + len(x) // 65536)])


def fit(head, x, standardised):
    held_out = of_held_out_frames(head)
    net = train(network(), weighed(head, x)[~held_out], standardised(x[~held_out]),
                mirror_with_foot(), shifts_loss, BATCH, DECAY, NOISE)
    out, tested = outputs(net, standardised, x[held_out]), head[held_out]
    error, _ = errors(out, torch.from_numpy(tested[:, 2:5]))
    print(f"held out: {len(tested)} samples, {left_of_shifts(out.numpy(), tested)}")
    with torch.no_grad():
        net[-1].bias[4:] += torch.from_numpy(np.log(np.quantile(abs(error.numpy()), 0.95, 0) / 2))
    return net


def of_some_inputs(net, standardised):
    """Of the features and the patch of some_features() and some_foot() in network_test.cpp."""
    return outputs(net, standardised,
                   np.concatenate([waves(FEATURES, 0.37), waves(PATCH, 0.23)])[None])


def main():
    arguments = parser(__doc__, "last_look_weights.inc").parse_args()
    torch.manual_seed(0)
    path = arguments.out / "last_look_weights.inc"
    if not arguments.dumps:
        nothing = np.zeros((1, FEATURES + PATCH), np.float32)
        write(Standardised(nothing, mirror_with_foot()), network(), path)
        return
    head, features, patches = load(arguments.dumps, 4 * PATCH)
    x = np.concatenate([features, patches.view(np.float32).astype(np.float16)], 1)
    standardised = Standardised(x[::8], mirror_with_foot())
    net = fit(head, x, standardised)
    write(standardised, net, path)
    write_golden("last_look.bin", of_some_inputs(net, standardised))


if __name__ == "__main__":
    main()
