"""Two network namespaces, a robot's and a planner's, and a link between them that loses packets, delays
them, or carries nothing. The kernel's own means for this (netem) is absent from many machines."""

import collections
import fcntl
import os
import random
import select
import struct
import subprocess
import threading
import time

import pytest

TUNSETIFF, IFF_TUN, IFF_NO_PI = 0x400454CA, 0x0001, 0x1000
ROBOT, PLANNER = "10.77.0.1", "10.77.0.2"


def ip(*words):
    subprocess.run(["ip", *words], check=True, capture_output=True)


class End:
    """A namespace and its end of the link, whose packets we read and write."""

    def __init__(self, name, address):
        self.name = f"bole-{name}-{os.getpid()}"
        self.prefix = ["ip", "netns", "exec", self.name]
        self._device = f"{name[:7]}{os.getpid()}"
        self.fd = os.open("/dev/net/tun", os.O_RDWR)
        request = struct.pack("16sH22x", self._device.encode(), IFF_TUN | IFF_NO_PI)
        fcntl.ioctl(self.fd, TUNSETIFF, request)
        ip("netns", "add", self.name)
        ip("link", "set", self._device, "netns", self.name)
        self._ip("addr", "add", f"{address}/24", "dev", self._device)
        self._ip("link", "set", "lo", "up")
        self.plug()

    def _ip(self, *words):
        ip("-n", self.name, *words)

    def plug(self):
        self._ip("link", "set", self._device, "up", "multicast", "on")
        self._ip("route", "add", "224.0.0.0/4", "dev", self._device)

    def unplug(self):
        self._ip("link", "set", self._device, "down")

    def close(self):
        os.close(self.fd)
        ip("netns", "delete", self.name)


class Link:
    """Carries packets between the two ends until the end of the `with`."""

    def __init__(self, loss=0.0, delay_s=0.0):
        self.silent = False  # loses everything
        self.lost = collections.Counter()  # packets from the robot that hold this text and were lost
        self._loss, self._delay_s = loss, delay_s
        self._random = random.Random(7)
        try:
            self.robot, self.planner = End("robot", ROBOT), End("planner", PLANNER)
        except (OSError, subprocess.CalledProcessError) as error:
            pytest.skip(f"no network namespaces with devices of our own here: {error}")
        self._stop = threading.Event()
        self._carrier = threading.Thread(target=self._carry)
        self._carrier.start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._stop.set()
        self._carrier.join()
        self.robot.close()
        self.planner.close()

    def _carry(self):
        """The delay is the same for all, so packets leave in the order of their coming."""
        ways = {self.robot.fd: self.planner.fd, self.planner.fd: self.robot.fd}
        under_way = collections.deque()  # (when it is due, where to, packet)
        while not self._stop.is_set():
            wait_s = under_way[0][0] - time.monotonic() if under_way else 0.05
            for fd in select.select(list(ways), [], [], max(wait_s, 0))[0]:
                packet = self._read(fd)
                if self.silent or self._random.random() < self._loss:
                    self._note_loss(fd, packet)
                else:
                    under_way.append((time.monotonic() + self._delay_s, ways[fd], packet))
            while under_way and under_way[0][0] <= time.monotonic():
                _, fd, packet = under_way.popleft()
                self._write(fd, packet)

    def _note_loss(self, fd, packet):
        for channel in ("BOLE_TREES", "BOLE_STATUS"):
            if fd == self.robot.fd and channel.encode() + b"\0" in packet:
                self.lost[channel] += 1

    @staticmethod
    def _read(fd):
        try:
            return os.read(fd, 2048)
        except OSError:  # the end is unplugged
            return b""

    @staticmethod
    def _write(fd, packet):
        try:
            os.write(fd, packet)
        except OSError:
            pass
