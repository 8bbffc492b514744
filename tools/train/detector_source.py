"""The border to the detector's C++: constants read from its source, arrays written for it, and what
a network says of the inputs of tests/unit/detect/network_test.cpp."""
import argparse
import pathlib
import re

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]


def constant(name, file):
    """What the detector's own source says."""
    return float(re.search(rf"\b{name} = ([\d.]+)F?;", (ROOT / file).read_text())[1])


LEAK = constant("kLeak", "src/detect/network/dense_layer.h")


def numbers(values):
    return ", ".join(np.format_float_positional(v, 6, fractional=False, trim="0") + "F"
                     for v in values)


def matrix(name, values):
    rows = ",\n    ".join("{" + numbers(row) + "}" for row in values)
    return f"constexpr float {name}[{len(values)}][{len(values[0])}] = {{\n    {rows}}};\n"


def biases(name, values):
    return f"constexpr std::array<float, {len(values)}> k{name}Bias = {{{numbers(values)}}};\n"


def waves(count, factor):
    """As in network_test.cpp."""
    i = np.arange(count)
    return np.sin(np.float32(factor) * (i * i % 101).astype(np.float32))


def write_golden(name, out):
    (ROOT / "tests/golden/detect" / name).write_bytes(out.numpy().astype("<f4").tobytes())


def parser(doc, files):
    """Of what each trainer is told."""
    arguments = argparse.ArgumentParser(description=doc,
                                        formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--out", required=True, type=pathlib.Path, help=f"the folder of {files}")
    arguments.add_argument("dumps", nargs="*")
    return arguments
