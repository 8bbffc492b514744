"""The border to the detector's C++: constants read from its source, arrays written for it."""
import pathlib
import re

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]


def constant(name, file):
    """What the detector's own source says."""
    return float(re.search(rf"\b{name} = ([\d.]+)F?;", (ROOT / file).read_text())[1])


LEAK = constant("kLeak", "src/detect/dense_layer.h")


def numbers(values):
    return ", ".join(np.format_float_positional(v, 6, fractional=False, trim="0") + "F"
                     for v in values)


def matrix(name, values):
    rows = ",\n    ".join("{" + numbers(row) + "}" for row in values)
    return f"constexpr float {name}[{len(values)}][{len(values[0])}] = {{\n    {rows}}};\n"


def biases(name, values):
    return f"constexpr std::array<float, {len(values)}> k{name}Bias = {{{numbers(values)}}};\n"
