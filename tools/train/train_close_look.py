#!/usr/bin/env python3
"""Trains the network for a close look on what `dump_candidates OUT close` wrote.

usage: train_close_look.py --out src/detect [DUMP...]

Without a dump it writes a network that knows nothing, to be built with. Each of the two patches
goes through convolutions of 3 x 3 cells at every other cell to a summary; two hidden layers see
both summaries and the features. A whole batch is shown mirrored, the patches in disguise, some
without features, and the features' noise stays to the end. What the network says of the inputs of
the detector's own test goes to the golden file of that.
"""
import numpy as np
import torch
from torch import nn
from torch.nn import functional

from detector_source import (LEAK, biases, constant, matrix, numbers, parser, waves,
                             write_golden)
from disguise import disguised
from likelihood import OUTPUTS, loss, report
from samples import (FEATURES, LIMIT, MIRRORED_HEAD, Standardised, load, mirror,
                     of_held_out_frames, weighed)

SIDE = int(constant("kSide", "src/detect/network/trunk_patches.h"))
CELL_UNITS = constant("kUnits", "src/detect/network/trunk_patches.h")
PATCHES = ("trunk", "around")
CHANNELS = (1, 16, 32, 48, 64)
LAYERS = ("First", "Second", "Third", "Fourth")
SUMMARY, FIRST, SECOND = 48, 96, 48
LAST_SIDE = SIDE // 2 ** (len(CHANNELS) - 1)
EPOCHS, BATCH, RATE, DECAY, NOISE = 20, 1024, 3e-3, 1e-2, 0.1
WITHOUT_FEATURES = 0.3  # share of the samples
# What whole numbers leave room for: of a unit, and of the sum of a unit's weights.
MOST_UNIT = 3.5
MOST_WEIGHTS = 0.99 * constant("kMostWeightsOfUnit", "src/detect/network/dense_layer.h")


def leaky(x):
    return functional.leaky_relu(x, LEAK)


class PatchSummary(nn.Module):
    def __init__(self):
        super().__init__()
        self.convolutions = nn.ModuleList(
            nn.Conv2d(a, b, 3, 2, 1) for a, b in zip(CHANNELS, CHANNELS[1:]))
        self.summary = nn.Linear(CHANNELS[-1] * LAST_SIDE ** 2, SUMMARY)

    def layers(self):
        return [*self.convolutions, self.summary]

    def forward(self, x):
        for convolution in self.convolutions:
            x = leaky(convolution(x))
        return leaky(self.summary(x.flatten(1)))


class CloseLook(nn.Module):
    def __init__(self):
        super().__init__()
        self.patches = nn.ModuleList(PatchSummary() for _ in PATCHES)
        self.first = nn.Linear(FEATURES + len(PATCHES) * SUMMARY, FIRST)
        self.second = nn.Linear(FIRST, SECOND)
        self.output = nn.Linear(SECOND, OUTPUTS)

    def forward(self, features, patches):
        seen = [net(patches[:, k:k + 1]) for k, net in enumerate(self.patches)]
        return self.output(leaky(self.second(leaky(self.first(torch.cat([features, *seen], 1))))))


class Samples:
    def __init__(self, paths):
        self.head, self.features, self.patches = load(paths, len(PATCHES) * SIDE ** 2)

    def batch(self, chosen, standardised):
        features = torch.from_numpy(standardised(self.features[chosen]).astype(np.float32))
        patches = torch.from_numpy(self.patches[chosen]).float() / CELL_UNITS
        return features, patches.view(-1, len(PATCHES), SIDE, SIDE)


def fit(samples, shown, standardised):
    source, sign = mirror()
    head = weighed(samples.head[shown], samples.features[shown])
    mirrored = torch.from_numpy(MIRRORED_HEAD)
    net = CloseLook()
    steps = len(shown) // BATCH
    optimiser = torch.optim.AdamW(net.parameters(), RATE, weight_decay=DECAY)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimiser, RATE, EPOCHS * steps, pct_start=0.1)
    random = np.random.default_rng(0)
    for epoch in range(EPOCHS):
        for chosen in random.permutation(len(shown))[:steps * BATCH].reshape(steps, BATCH):
            chosen.sort()
            features, patches = samples.batch(shown[chosen], standardised)
            truth = torch.from_numpy(head[chosen])
            if random.random() < 0.5:
                features = features[:, source] * torch.from_numpy(sign)
                patches, truth = patches.flip(3), truth * mirrored
            features += NOISE * torch.randn_like(features)
            features *= torch.rand(len(features), 1) > WITHOUT_FEATURES
            optimiser.zero_grad()
            with torch.autocast("cpu", torch.bfloat16):  # half the time
                out = net(features, disguised(patches))
            loss(out.float(), truth).backward()
            optimiser.step()
            schedule.step()
        print(f"round {epoch + 1} of {EPOCHS}", flush=True)
    return net


@torch.no_grad()
def outputs(net, samples, shown, standardised):
    return np.concatenate([net(*samples.batch(part, standardised)).numpy()
                           for part in np.array_split(shown, 1 + len(shown) // 4096)])


@torch.no_grad()
def even_out(net, patches):
    """Makes all units and weights fit into whole numbers: leaky units keep their shape when they are
    scaled, so what one layer is divided by the next is multiplied by."""
    for k, summary in enumerate(net.patches):
        x = patches[:, k:k + 1]
        layers = summary.layers()
        inputs = slice(FEATURES + k * SUMMARY, FEATURES + (k + 1) * SUMMARY)
        following = [layer.weight for layer in layers[1:]] + [net.first.weight[:, inputs]]
        for layer, after in zip(layers, following):
            x = leaky(layer(x.flatten(1) if isinstance(layer, nn.Linear) else x))
            share = MOST_UNIT / x.abs().flatten().sort().values[-1 - x.numel() // 100000]
            layer.weight *= share
            layer.bias *= share
            x *= share
            after /= share
    share = (MOST_WEIGHTS / net.first.weight.abs().sum(1)).clamp(max=1)
    net.first.weight *= share[:, None]
    net.first.bias *= share
    net.second.weight /= share


def write(net, standardised, path):
    with open(path, "w") as out:
        out.write(f"""// Written by tools/train/train_close_look.py.
namespace {path.stem} {{
constexpr int kInputs = {net.first.in_features}, kFirst = {FIRST}, kSecond = {SECOND}, \
kOutputs = {OUTPUTS};
constexpr float kLimit = {LIMIT}F;
constexpr float kMean[] = {{{numbers(standardised.mean)}}};
constexpr float kScale[] = {{{numbers(standardised.scale)}}};
""")

        def layer(name, weights, bias, indent=""):
            out.write(indent + biases(name, bias.detach().numpy()))
            out.write(indent + matrix(f"kTo{name}", weights.detach().numpy()))

        for name, summary in zip(PATCHES, net.patches):
            out.write(f"struct {name.title()} {{\n")
            for unit, convolution in zip(LAYERS, summary.convolutions):
                weights = convolution.weight.permute(2, 3, 1, 0)  # row, column, from, to
                layer(unit, weights.reshape(-1, weights.shape[3]), convolution.bias, "  static ")
            cells = summary.summary.weight.view(SUMMARY, CHANNELS[-1], LAST_SIDE, LAST_SIDE)
            layer("Summary", cells.permute(2, 3, 1, 0).reshape(-1, SUMMARY), summary.summary.bias,
                  "  static ")
            out.write("};\n")
        for name, dense in (("First", net.first), ("Second", net.second), ("Output", net.output)):
            layer(name, dense.weight.T, dense.bias)
        out.write(f"}}  // namespace {path.stem}\n")


@torch.no_grad()
def of_some_inputs(net, standardised):
    """Of the features and patches of some_features() and some_patches() in network_test.cpp."""
    features = waves(FEATURES, 0.37)[None]
    i = np.arange(SIDE ** 2)
    patches = np.stack([i * i % 101 - 50, i * i % 67 - 33]).reshape(1, len(PATCHES), SIDE, SIDE)
    return net(torch.from_numpy(standardised(features).astype(np.float32)),
               torch.from_numpy(patches).float() / CELL_UNITS)


def main():
    arguments = parser(__doc__, "close_look_weights.inc").parse_args()
    torch.manual_seed(0)
    path = arguments.out / "close_look_weights.inc"
    if not arguments.dumps:
        nothing = np.zeros((1, FEATURES), np.float32)
        write(CloseLook(), Standardised(nothing, mirror()), path)
        return
    samples = Samples(arguments.dumps)
    held_out = of_held_out_frames(samples.head)
    shown, tested = np.flatnonzero(~held_out), np.flatnonzero(held_out)
    standardised = Standardised(samples.features[shown[::8]], mirror())
    net = fit(samples, shown, standardised)
    report(outputs(net, samples, tested, standardised), samples.head[tested])
    even_out(net, samples.batch(shown[::200], standardised)[1])
    write(net, standardised, path)
    write_golden("close_look.bin", of_some_inputs(net, standardised))


if __name__ == "__main__":
    main()
