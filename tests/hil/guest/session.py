"""Runs the scenarios inside the guest, one after another, and reports each in one line.

A scenario is a module of tests/hil/scenarios with a docstring that says what it shows, SMOKE (is it
part of the smoke run), TIME_LIMIT_S and run(), which returns if all is well, raises Skip, or raises
anything else. With --list, prints them (on the host).
"""

import importlib
import os
import pathlib
import signal
import sys
import time
import traceback

HERE = pathlib.Path(__file__).resolve().parent
SCENARIOS = HERE.parent / "scenarios"
sys.path[:0] = [str(HERE), str(SCENARIOS)]

from rig import environment  # noqa: E402
from rig.wait import Skip  # noqa: E402


def main():
    scenarios = {path.stem: path for path in sorted(SCENARIOS.glob("*.py"))}
    if sys.argv[1:] == ["--list"]:
        for name in scenarios:
            module = importlib.import_module(name)
            smoke = "smoke" if module.SMOKE else "     "
            print(f"{name:24} {smoke}  {module.__doc__.splitlines()[0]}")
        return
    status = 1
    try:
        status = 0 if run_all(choose(scenarios)) else 1
    except Exception as error:
        print(f"FAIL hil  {error}", flush=True)
    pathlib.Path("/hil/out/status").write_text(f"{status}\n")


def choose(scenarios):
    """The modules to run."""
    wanted = os.environ["HIL_SCENARIOS"].split() or list(scenarios)
    if unknown := set(wanted) - set(scenarios):
        raise ValueError(f"no such scenario: {', '.join(sorted(unknown))}")
    modules = [importlib.import_module(name) for name in wanted]
    if os.environ["HIL_SELECTION"] == "smoke":
        modules = [module for module in modules if module.SMOKE]
    return modules


def run_all(modules):
    boot_s = time.monotonic()
    environment.prepare()
    outcomes = [run_one(module) for module in modules]
    counts = {outcome: outcomes.count(outcome) for outcome in ("PASS", "FAIL", "SKIP")}
    print(
        f"hil: {counts['PASS']} passed, {counts['FAIL']} failed, {counts['SKIP']} skipped in "
        f"{time.monotonic():.0f} s of the guest's clock ({boot_s:.0f} s of them booting, "
        f"{os.environ['HIL_ACCELERATOR']})",
        flush=True,
    )
    return counts["FAIL"] == 0


def run_one(module):
    name = module.__name__
    environment.begin_scenario(name)
    start = time.monotonic()
    outcome, reason = "PASS", ""
    signal.signal(signal.SIGALRM, lambda *_: time_is_up(module.TIME_LIMIT_S))
    signal.alarm(module.TIME_LIMIT_S)
    try:
        note = module.run()
        reason = note or ""
    except Skip as skip:
        outcome, reason = "SKIP", str(skip)
    except Exception as error:
        outcome, reason = "FAIL", f"{type(error).__name__}: {error}"
        (environment.scenario_directory() / "traceback").write_text(traceback.format_exc())
    finally:
        signal.alarm(0)
    print(f"{outcome} {name:24} {time.monotonic() - start:6.1f} s  {reason}".rstrip(), flush=True)
    return outcome


def time_is_up(limit_s):
    raise TimeoutError(f"not done after {limit_s} s")


if __name__ == "__main__":
    main()
