"""Programs that run beside a test: boled, and receivers that share no code with it."""

import contextlib
import json
import os
import pathlib
import re
import signal
import socket
import subprocess
import sys
import threading
import time

HERE = pathlib.Path(__file__).resolve().parent


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def free_endpoint(protocol="tcp"):
    return f"{protocol}/127.0.0.1:{free_port()}"


def listening(endpoint):
    """Whether somebody takes connections there."""
    host, port = endpoint.split("/")[1].split(":")
    with socket.socket() as probe:
        return probe.connect_ex((host, int(port))) == 0


def eventually(condition, seconds=10):
    """Whether the condition comes true in time; what it returned last."""
    end = time.monotonic() + seconds
    while not (result := condition()) and time.monotonic() < end:
        time.sleep(0.01)
    return result


@contextlib.contextmanager
def running(command, **options):
    """A process that is killed when the `with` is left: a test that fails must not wait for it."""
    with subprocess.Popen(command, **options) as process:
        try:
            yield process
        finally:
            process.kill()


class Daemon:
    """boled over a folder of frames, again and again, until the end of the `with` or stop()."""

    def __init__(self, programs, frames, log, *arguments, prefix=()):
        command = [*prefix, programs / "boled", "--camera", frames / "camera.toml", "--source",
                   f"replay:{frames}", "--loop", *arguments]
        self._log = log
        with open(log, "w") as stderr:
            self.process = subprocess.Popen(command, stderr=stderr)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()

    def log(self):
        return self._log.read_text()

    def rss_kb(self):
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(r"RssAnon:\s+(\d+) kB", status)[1])

    def stop(self):
        """Ends it; its whole log, closed by the summary."""
        self.process.terminate()
        assert self.process.wait(10) == 0
        return self.log()


class Client:
    """A receiver: the lines that it prints with the times of their arrival. `settings` are zenoh's."""

    def __init__(self, script, *arguments, prefix=(), settings=None):
        command = [*prefix, sys.executable, HERE / script, *arguments]
        env = {**os.environ, "ZENOH_SETTINGS": json.dumps(settings or {})}
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=env)
        self.lines = []  # (time.monotonic_ns(), line)
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        for line in self.process.stdout:
            self.lines.append((time.monotonic_ns(), line.rstrip("\n")))

    def __enter__(self):
        assert self.is_ready(), self.lines
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        self.process.send_signal(signal.SIGKILL)
        self.process.wait()
        self._reader.join()
        self.process.stdout.close()

    def is_ready(self, seconds=20):
        return eventually(lambda: self.lines or self.process.poll() is not None, seconds) and (
            self.lines[0][1] == "ready" if self.lines else False
        )

    def received(self):
        """(arrival in ns, key or channel, payload) of each message so far."""
        messages = []
        for arrival_ns, line in list(self.lines)[1:]:
            words = line.split()
            messages.append((arrival_ns, words[0], bytes.fromhex(words[-1])))
        return messages

    def lists(self, types):
        """(arrival in ns, tree_list_t) of each list so far."""
        return [
            (arrival_ns, types.tree_list_t.decode(payload))
            for arrival_ns, name, payload in self.received()
            if name.endswith(("/trees", "BOLE_TREES"))
        ]

    def last_status(self, types):
        for _, name, payload in reversed(self.received()):
            if name.endswith(("/status", "BOLE_STATUS")):
                return types.status_t.decode(payload)
        return None


def gaps(seqs):
    """How many are missing between the first and the last."""
    assert seqs == sorted(seqs)
    return seqs[-1] - seqs[0] + 1 - len(seqs)


def bus_summary(log, bus):
    """(published, overwritten, failed) of the summary at the end of a daemon's log."""
    return tuple(
        map(int, re.search(rf"{bus}: (\d+) published, (\d+) overwritten, (\d+) failed", log).groups())
    )


def replay_summary(log):
    """(frames, lists, latency p99 in ms) of the same."""
    frames, lists = re.search(r"replay: (\d+) frames, (\d+) lists", log).groups()
    return int(frames), int(lists), float(re.search(r"latency .* p99 ([\d.]+) ms", log)[1])
