"""Patches as another wood, light and camera might show them.

What of a trunk holds in spite of it is less likely to be the simulator's own: networks that were
taught without know our bark, and find fewer trunks in photographs.
"""
import torch
from torch.nn import functional

# In the patch's standard deviations: light that falls unevenly, grain, bend of the tone curve.
MOST_LIGHT, MOST_GRAIN, MOST_BEND = 0.6, 0.5, 0.15
LIGHT_CELLS = 5  # to a side: how fine the light is
LEAVES, MOST_LEAF, BRIGHTEST_LEAF = 0.4, 6, 2.0  # share of the patches, half its side in cells
LEAST_SPREAD = 0.1


def each(patches, low, high):
    """A number for each of the patches, drawn anew."""
    return low + (high - low) * torch.rand(*patches.shape[:2], 1, 1)


def disguised(patches):
    """`patches`: pictures x patches x rows x columns, standardised; so is what comes back."""
    light = torch.randn(*patches.shape[:2], LIGHT_CELLS, LIGHT_CELLS)
    light = functional.interpolate(light, patches.shape[2:], mode="bilinear", align_corners=True)
    patches = patches + each(patches, 0, MOST_LIGHT) * light
    patches = patches + each(patches, 0, MOST_GRAIN) * torch.randn_like(patches)
    patches = patches + each(patches, -MOST_BEND, MOST_BEND) * patches.square()
    patches = with_leaf(patches)
    spread, mean = torch.std_mean(patches, (2, 3), keepdim=True)
    return (patches - mean) / spread.clamp(min=LEAST_SPREAD)


def with_leaf(patches):
    """A leaf, or a pool of light: within a box, all of one brightness."""
    rows, columns = (torch.arange(side) for side in patches.shape[2:])
    beside = (columns - each(patches, 0, len(columns))).abs() < each(patches, 0, MOST_LEAF)
    above = (rows.view(-1, 1) - each(patches, 0, len(rows))).abs() < each(patches, 0, MOST_LEAF)
    hidden = beside & above & (each(patches, 0, 1) < LEAVES)
    return torch.where(hidden, each(patches, -BRIGHTEST_LEAF, BRIGHTEST_LEAF), patches)
