#!/usr/bin/env python3
"""Trains the detector's network on what dump_candidates wrote.

usage: train.py --out src/detect/weights.inc [DUMP...]

Without a dump it writes a network that knows nothing, for changed features to be built with.

One hidden layer of 96 leaky units over the standardised features, and seven outputs: the logit of
'this is a trunk', the shifts of middle, log width and foot that lead to it, and the logarithms of
their standard deviations. Every sample is shown mirrored, too. Gaussian noise on the inputs keeps
the network from leaning on details that only the simulator has; the last epochs, without noise, teach
the shifts and their deviations alone. Every eighth frame is held out and only reported on. The same
dumps give the same weights.
"""
import argparse

import numpy as np

HEAD = 6  # frame, label, three shifts, weight: see dump_candidates.cpp
HEIGHTS, ACROSS, FOOT_ROWS, STRIPS, NUMBERS = 11, 12, 16, 3, 19  # see trunk_features.h
GRID = HEIGHTS * ACROSS
FEATURES = GRID + FOOT_ROWS * STRIPS + NUMBERS
LEFT_RIGHT_NUMBERS = [(5, 6), (8, 9), (13, 14)]  # that change places in a mirror
SIDEWAYS_NUMBERS = [18]  # that change sign in a mirror
POLARITY_NUMBER = 3  # 1 dark, -1 bright
HIDDEN, OUTPUTS, LEAK = 96, 7, 0.05
LIMIT = 4.0  # of a standardised feature
BRIGHT_WEIGHT = 2.5  # of bright trunks: they are the fewer, but as good to run into
EPOCHS, LAST_EPOCHS, BATCH, RATE, DECAY, NOISE = 20, 5, 512, 3e-3, 1e-4, 0.3


def load(paths):
    rows = np.concatenate([np.fromfile(p, np.float32).reshape(-1, HEAD + FEATURES) for p in paths])
    return rows[:, :HEAD], rows[:, HEAD:]


def mirrored(head, x):
    m, n = x.copy(), GRID + FOOT_ROWS * STRIPS
    m[:, :GRID] = x[:, :GRID].reshape(-1, HEIGHTS, ACROSS)[:, :, ::-1].reshape(-1, GRID)
    m[:, GRID:n] = x[:, GRID:n].reshape(-1, FOOT_ROWS, STRIPS)[:, :, ::-1].reshape(-1, n - GRID)
    for a, b in LEFT_RIGHT_NUMBERS:
        m[:, n + a], m[:, n + b] = x[:, n + b], x[:, n + a]
    for a in SIDEWAYS_NUMBERS:
        m[:, n + a] *= -1
    return head * np.float32([1, 1, -1, 1, 1, 1]), m


class Network:
    def __init__(self, x, random):
        self.mean, self.scale = x.mean(0), 1 / (x.std(0) + 1e-3)
        first = random.normal(0, np.sqrt(2 / FEATURES), (FEATURES, HIDDEN))
        second = random.normal(0, 0.1, (HIDDEN, OUTPUTS))
        bias = [0, 0, 0, 0, -2, -2, 0]
        self.weights = [np.float32(w) for w in (first, np.zeros(HIDDEN), second, bias)]

    def standardised(self, x):
        return ((x - self.mean) * self.scale).clip(-LIMIT, LIMIT).astype(np.float32)

    def forward(self, z):
        first, hidden_bias, second, output_bias = self.weights
        sums = z @ first + hidden_bias
        hidden = np.where(sums > 0, sums, LEAK * sums)
        return sums, hidden, hidden @ second + output_bias

    def gradients(self, z, head):
        sums, hidden, out = self.forward(z)
        label, shifts, weight = head[:, 1], head[:, 2:5], head[:, 5]
        g = np.zeros_like(out)
        g[:, 0] = (1 / (1 + np.exp(-out[:, 0].clip(-30, 30))) - label) * weight
        # The shifts' negative log likelihood; large errors pull like a Laplacian's.
        trunk = (0.12 * weight * (label == 1))[:, None]
        log_sigma = out[:, 4:].clip(-4.5, 3)
        error = (out[:, 1:4] - shifts) * np.exp(-log_sigma)
        damped = np.exp(-log_sigma) * np.minimum(1, 8 * np.exp(log_sigma))
        g[:, 1:4] = trunk * error.clip(-3, 3) * damped
        g[:, 4:] = trunk * (1 - error * error.clip(-3, 3))
        g /= len(z)
        back = (g @ self.weights[2].T) * np.where(sums > 0, 1, LEAK)
        return [z.T @ back + DECAY * self.weights[0], back.sum(0), hidden.T @ g, g.sum(0)]


def train(head, x, random):
    network = Network(x, random)
    z = network.standardised(x)
    head = head.copy()
    head[:, 5] = np.minimum(head[:, 5], 8)
    bright = x[:, GRID + FOOT_ROWS * STRIPS + POLARITY_NUMBER] < 0
    head[bright & (head[:, 1] == 1), 5] *= BRIGHT_WEIGHT
    head[:, 5] /= head[:, 5].mean()
    first = [np.zeros_like(w) for w in network.weights]
    second = [np.zeros_like(w) for w in network.weights]
    step, steps = 0, (EPOCHS + LAST_EPOCHS) * (len(z) // BATCH)
    for epoch in range(EPOCHS + LAST_EPOCHS):
        last = epoch >= EPOCHS
        for batch in np.array_split(random.permutation(len(z)), len(z) // BATCH):
            noise = 0 if last else NOISE * random.standard_normal((len(batch), FEATURES), np.float32)
            step += 1
            rate = RATE * min(1, step / 200) * (0.5 + 0.5 * np.cos(np.pi * step / steps)) + 1e-5
            gradients = network.gradients(z[batch] + noise, head[batch])
            if last:
                rate = max(rate, 5e-4)
                gradients = [0 * gradients[0], 0 * gradients[1], *gradients[2:]]
                gradients[2][:, 0] = gradients[3][0] = 0
                first = [f * (g != 0) for f, g in zip(first, gradients)]
            for i, g in enumerate(gradients):  # Adam
                first[i] = 0.9 * first[i] + 0.1 * g
                second[i] = 0.999 * second[i] + 0.001 * g * g
                change = first[i] / (1 - 0.9**step) / (np.sqrt(second[i] / (1 - 0.999**step)) + 1e-7)
                network.weights[i] -= np.float32(rate * change)
    return network


def report(network, head, x):
    out = network.forward(network.standardised(x))[2]
    trunk, weight = head[:, 1] == 1, head[:, 5]
    p = 1 / (1 + np.exp(-out[:, 0]))
    loss = -(weight * np.log(np.where(trunk, p, 1 - p) + 1e-9)).mean()
    left = np.median(abs(head[trunk, 2:5] - out[trunk, 1:4]), 0) * 1.48
    print(f"held out: {len(x)} samples, log loss {loss:.4f}, recall {(p[trunk] > 0.5).mean():.3f}, "
          f"left of the shifts {left.round(3)} of {head[trunk, 2:5].std(0).round(3)}")


def write(network, path):
    def numbers(values):
        return ", ".join(np.format_float_positional(v, 6, fractional=False, trim="0") + "F"
                         for v in values)

    def rows(matrix):
        return ",\n    ".join("{" + numbers(row) + "}" for row in matrix)

    first, hidden_bias, second, output_bias = network.weights
    with open(path, "w") as out:
        out.write(f"""// Written by tools/train/train.py.
namespace weights {{
constexpr int kInputs = {FEATURES}, kHidden = {HIDDEN}, kOutputs = {OUTPUTS};
constexpr float kLimit = {LIMIT}F;
constexpr float kMean[kInputs] = {{{numbers(network.mean)}}};
constexpr float kScale[kInputs] = {{{numbers(network.scale)}}};
constexpr std::array<float, kHidden> kHiddenBias = {{{numbers(hidden_bias)}}};
constexpr std::array<float, kOutputs> kOutputBias = {{{numbers(output_bias)}}};
constexpr float kFirst[kInputs][kHidden] = {{
    {rows(first)}}};
constexpr float kSecond[kHidden][kOutputs] = {{
    {rows(second)}}};
}}  // namespace weights
""")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", required=True)
    parser.add_argument("dumps", nargs="*")
    arguments = parser.parse_args()
    if not arguments.dumps:
        write(Network(np.zeros((1, FEATURES), np.float32), np.random.default_rng(0)), arguments.out)
        return
    head, x = load(arguments.dumps)
    held_out = head[:, 0].astype(int) % 8 == 0
    twins = mirrored(head[~held_out], x[~held_out])
    network = train(np.concatenate([head[~held_out], twins[0]]),
                    np.concatenate([x[~held_out], twins[1]]), np.random.default_rng(0))
    report(network, head[held_out], x[held_out])
    write(network, arguments.out)


if __name__ == "__main__":
    main()
