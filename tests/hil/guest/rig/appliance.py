"""boled under test, seen as its users see it: over LCM, in its log, and from the outside as a
process."""

import json
import pathlib
import time

from rig import environment
from rig.process import Process
from rig.wait import Skip, wait_until

STATES = ("starting", "opening", "streaming", "stalled", "no camera", "stopping")


def camera_file(size):
    """camera.toml of the rig's camera of this (width, height)."""
    return environment.source("tests/hil/cameras", f"{size[0]}x{size[1]}", "camera.toml")


class Boled(Process):
    """A boled with its logs among the scenario's. `settings` are those of --set."""

    def __init__(self, source, size, *settings, publish="lcm", wrapper=(), name="boled"):
        program = environment.build("firmware_app/boled")
        if not program.exists():
            raise Skip("boled is not built")
        command = [*wrapper, program, "--camera", camera_file(size), "--source", source,
                   "--publish", publish]
        cache = f'camera.cache_directory="{environment.SCRATCH / "tables"}"'
        for setting in (cache, *settings):
            command += ["--set", setting]
        super().__init__(name, command)

    @property
    def pid(self):
        return self.child.pid

    def log_lines(self, part):
        """The lines of the log so far that contain this."""
        return [line for line in self.stderr.since() if part in line]

    def wait_for_log(self, part, timeout_s, mark=0):
        return self.stderr.wait_for(lambda line: part in line, timeout_s, f"log: {part}", mark)

    def holdings(self):
        """What a leak would make more of: descriptors, mappings, threads."""
        process = pathlib.Path("/proc", str(self.pid))
        return {
            "descriptors": len(list((process / "fd").iterdir())),
            "mappings": len((process / "maps").read_text().splitlines()),
            "threads": len(list((process / "task").iterdir())),
        }


class Listener(Process):
    """A subscriber: bolectl listen. Each message is a dictionary with the type's field names."""

    def __init__(self):
        super().__init__("listener", [environment.build("firmware_app/bolectl"), "listen", "--json"])

    def mark(self):
        """A position among the messages: what comes from now on."""
        return self.stdout.mark()

    def lists(self, mark=0):
        return [message for message in map(json.loads, self.stdout.since(mark)) if _is_list(message)]

    def last_status(self):
        statuses = [m for m in map(json.loads, self.stdout.since()) if _is_status(m)]
        return statuses[-1] if statuses else None

    def wait_for_list(self, timeout_s=20, mark=0, wanted=lambda message: True):
        """The first list from `mark` on for which wanted(list) holds, with its arrival time."""

        def matches(line):
            message = json.loads(line)
            return message if _is_list(message) and wanted(message) else None

        return self.stdout.wait_for(matches, timeout_s, "a list", mark)

    def wait_for_new_list(self, timeout_s=20):
        """The first list of a frame taken from now on, with its arrival time."""
        now_ns = time.monotonic_ns()
        return self.wait_for_list(timeout_s, self.mark(), lambda one: one["capture_mono_ns"] > now_ns)

    def wait_for_lists(self, count, timeout_s, mark=0):
        """Waits until there have been this many lists from `mark` on."""
        wait_until(lambda: len(self.lists(mark)) >= count, timeout_s, f"{count} lists")

    def wait_for_status(self, wanted, timeout_s, what, mark=0):
        """The first status from `mark` on for which wanted(status) holds, with its arrival time."""

        def matches(line):
            message = json.loads(line)
            return message if _is_status(message) and wanted(message) else None

        return self.stdout.wait_for(matches, timeout_s, what, mark)

    def wait_for_state(self, state, timeout_s=20, mark=0):
        return self.wait_for_status(
            lambda status: STATES[status["state"]] == state, timeout_s, f'state "{state}"', mark)


def replug(camera, listener):
    """Seconds from pulling out to the status that says so, and from the camera being there again to
    a list."""
    mark = listener.mark()
    unplugged = time.monotonic()
    camera.unplug()
    outage_seen, _ = listener.wait_for_state("no camera", 10, mark)
    camera.plug()
    there = time.monotonic()
    back, _ = listener.wait_for_new_list(30)
    return outage_seen - unplugged, back - there


def drops(status):
    """A status' counters of frames that gave no list, by cause."""
    return _by_name(status["drops"])


def camera_events(status):
    """A status' counters of what befell the camera."""
    return _by_name(status["camera_events"])


def _by_name(counters):
    return {counter["name"]: counter["count"] for counter in counters}


def _is_list(message):
    return "trees" in message


def _is_status(message):
    return "state" in message
