"""Waiting for things to happen. Scenarios never sleep for a fixed time."""

import time

POLL_INTERVAL_S = 0.01


class Skip(Exception):
    """The scenario cannot run here; the text says why."""


def wait_until(condition, timeout_s, what):
    """Polls condition() until it gives something true, and returns that. Raises TimeoutError."""
    deadline = time.monotonic() + timeout_s
    while not (result := condition()):
        if time.monotonic() > deadline:
            raise TimeoutError(f"{what}: not within {timeout_s} s")
        time.sleep(POLL_INTERVAL_S)
    return result


def expect(actual, wanted, what):
    """Raises AssertionError, showing both, unless they are equal."""
    if actual != wanted:
        raise AssertionError(f"{what}: {actual!r} where {wanted!r} was expected")
