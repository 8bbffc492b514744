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


def loss(out, head):
    trunk, shifts, weight = head[:, 1], head[:, 2:5], head[:, 5]
    logit = functional.binary_cross_entropy_with_logits(out[:, 0], trunk, reduction="none")
    # The shifts' negative log likelihood; large errors pull like a Laplacian's.
    log_sigma = out[:, 4:].clamp(*LOG_SIGMAS)
    error = (out[:, 1:4] - shifts) * torch.exp(-log_sigma)
    far = functional.huber_loss(error, torch.zeros_like(error), reduction="none",
                                delta=LARGE_ERROR)
    shift = (far + log_sigma).sum(1)
    return (weight * (logit + SHIFTS_WEIGHT * trunk * shift)).mean()


def report(out, head):
    trunk, weight = head[:, 1] == 1, np.minimum(head[:, 5], MOST_WEIGHT)
    log_loss = np.logaddexp(0, np.where(trunk, -out[:, 0], out[:, 0]))
    taken = out[:, 0] > 0
    left = np.median(abs(head[trunk, 2:5] - out[trunk, 1:4]), 0) * 1.48
    print(f"held out: {len(head)} samples, log loss {np.average(log_loss, weights=weight):.4f}, "
          f"recall {taken[trunk].mean():.3f}, "
          f"precision {(trunk * weight)[taken].sum() / max(1, weight[taken].sum()):.3f}, "
          f"left of the shifts {left.round(3)} of {head[trunk, 2:5].std(0).round(3)}")
