"""What the networks' outputs say of a sample: the loss that they are trained by, and its report.

The outputs are the logit of 'this is a trunk', the shifts of middle, log width and foot that lead
to it, and the logarithms of their standard deviations.
"""
import numpy as np
import torch
from torch.nn import functional

from samples import MOST_WEIGHT

OUTPUTS = 7
SHIFTS_WEIGHT = 0.12  # of their likelihood beside the logit's
LOG_SIGMAS, LARGE_ERROR = (-4.5, 3), 3.0  # of the shifts; the error in sigmas
DEGREES = 3  # of freedom, of Student's t


def errors(out, shifts):
    """Of the shifts, in standard deviations, and the logarithms of these."""
    log_sigma = out[:, 4:].clamp(*LOG_SIGMAS)
    return (out[:, 1:4] - shifts) * torch.exp(-log_sigma), log_sigma


def loss(out, head):
    trunk, shifts, weight = head[:, 1], head[:, 2:5], head[:, 5]
    logit = functional.binary_cross_entropy_with_logits(out[:, 0], trunk, reduction="none")
    # The shifts' negative log likelihood; large errors pull like a Laplacian's.
    error, log_sigma = errors(out, shifts)
    far = functional.huber_loss(error, torch.zeros_like(error), reduction="none",
                                delta=LARGE_ERROR)
    shift = (far + log_sigma).sum(1)
    return (weight * (logit + SHIFTS_WEIGHT * trunk * shift)).mean()


def shifts_loss(out, head):
    """Of the shifts alone, by Student's t: the few feet that something hides do not pull at what is
    said of the others, as they do where errors are normal."""
    error, log_sigma = errors(out, head[:, 2:5])
    far = 0.5 * (DEGREES + 1) * torch.log1p(error.square() / DEGREES)
    return (head[:, 5] * (far + log_sigma).sum(1)).mean()


def report(out, head):
    trunk, weight = head[:, 1] == 1, np.minimum(head[:, 5], MOST_WEIGHT)
    log_loss = np.logaddexp(0, np.where(trunk, -out[:, 0], out[:, 0]))
    taken = out[:, 0] > 0
    print(f"held out: {len(head)} samples, log loss {np.average(log_loss, weights=weight):.4f}, "
          f"recall {taken[trunk].mean():.3f}, "
          f"precision {(trunk * weight)[taken].sum() / max(1, weight[taken].sum()):.3f}, "
          + left_of_shifts(out[trunk], head[trunk]))


def left_of_shifts(out, trunks):
    left = np.median(abs(trunks[:, 2:5] - out[:, 1:4]), 0) * 1.48
    return f"left of the shifts {left.round(3)} of {trunks[:, 2:5].std(0).round(3)}"
