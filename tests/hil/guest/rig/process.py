"""Child processes whose output can be waited for, line by line."""

import signal
import subprocess
import threading
import time

from rig import environment


class Process:
    """A child process. Its standard output and error go to <name>.out and <name>.err among the
    scenario's logs, and can be read and waited for while it runs. Leaving the context ends it."""

    def __init__(self, name, command, **popen_options):
        self.name = name
        self.child = subprocess.Popen(
            [str(word) for word in command],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            errors="replace",
            bufsize=1,
            **popen_options,
        )
        self.stdout = Lines(self.child.stdout, f"{name}.out")
        self.stderr = Lines(self.child.stderr, f"{name}.err")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.end()

    def end(self, timeout_s=30):
        """Asks the process to end, then waits for it; returns its exit status (minus a signal)."""
        self.child.stdin.close()
        self.signal(signal.SIGTERM)
        return self.wait(timeout_s)

    def signal(self, number):
        if self.child.poll() is None:
            self.child.send_signal(number)

    def wait(self, timeout_s):
        """Waits for the end and for the last of the output; returns the exit status."""
        try:
            status = self.child.wait(timeout_s)
        except subprocess.TimeoutExpired:
            self.child.kill()
            self.child.wait()
            raise TimeoutError(f"{self.name} did not end within {timeout_s} s") from None
        self.stdout.join()
        self.stderr.join()
        return status


class Lines:
    """The lines of a stream as they come, each with the time of its arrival."""

    def __init__(self, stream, log_name):
        self._changed = threading.Condition()
        self._lines = []  # (monotonic time, text)
        self._ended = False
        log_path = environment.scenario_directory() / log_name
        self._thread = threading.Thread(target=self._read, args=(stream, log_path), daemon=True)
        self._thread.start()

    def _read(self, stream, log_path):
        with stream, open(log_path, "a", buffering=1) as log:
            for text in stream:
                log.write(text)
                with self._changed:
                    self._lines.append((time.monotonic(), text.rstrip("\n")))
                    self._changed.notify_all()
        with self._changed:
            self._ended = True
            self._changed.notify_all()

    def join(self):
        self._thread.join()

    def mark(self):
        """A position: what comes from now on."""
        with self._changed:
            return len(self._lines)

    def since(self, mark=0):
        """The lines from the position on."""
        with self._changed:
            return [text for _, text in self._lines[mark:]]

    def wait_for(self, matches, timeout_s, what, mark=0):
        """Waits for the first line from `mark` on for which matches(line) is true. Returns
        (arrival time, what matches() gave). Raises TimeoutError; EOFError once none can come."""
        deadline = time.monotonic() + timeout_s
        with self._changed:
            while True:
                while mark < len(self._lines):
                    arrival, text = self._lines[mark]
                    mark += 1
                    if result := matches(text):
                        return arrival, result
                if self._ended:
                    raise EOFError(f"{what}: the process ended without it")
                if not self._changed.wait(deadline - time.monotonic()):
                    raise TimeoutError(f"{what}: not within {timeout_s} s")
