"""What stands on the wire, and how soon: sizes of datagrams and of Zenoh's batches, hand-over times."""

import math
import re
import shutil
import socket
import struct
import threading
import time

import pytest
from processes import Client, Daemon, eventually, free_endpoint

MOST_BYTES = 1400


class Tap:
    """Passes a TCP connection on, and keeps the sizes of the batches that its opener sends. A batch of
    Zenoh's goes behind two bytes, which hold its length."""

    def __init__(self, endpoint):
        self.sizes = []
        self._target = int(endpoint.rpartition(":")[2])
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.endpoint = f"tcp/127.0.0.1:{self._listener.getsockname()[1]}"
        threading.Thread(target=self._serve, daemon=True).start()

    def _serve(self):
        opener, _ = self._listener.accept()
        target = socket.create_connection(("127.0.0.1", self._target))
        threading.Thread(target=self._pass_back, args=(target, opener), daemon=True).start()
        try:
            while True:
                head = self._read(opener, 2)
                (length,) = struct.unpack("<H", head)
                target.sendall(head + self._read(opener, length))
                self.sizes.append(2 + length)
        except OSError:
            target.close()

    @staticmethod
    def _read(source, count):
        data = b""
        while len(data) < count:
            if not (more := source.recv(count - len(data))):
                raise OSError("closed")
            data += more
        return data

    @staticmethod
    def _pass_back(target, opener):
        try:
            while data := target.recv(65536):
                opener.sendall(data)
        except OSError:
            pass


def datagrams(url):
    """A socket that hears what LCM sends to the URL."""
    address, port = url.removeprefix("udpm://").partition("?")[0].split(":")
    listener = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
    listener.bind((address, int(port)))
    group = socket.inet_aton(address) + socket.inet_aton("0.0.0.0")
    listener.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, group)
    listener.settimeout(5)
    return listener


def test_the_largest_list_fits_a_datagram_on_both_buses(
    programs, raw_drive, tmp_path, types, lcm_url, report
):
    """The paper's detector, told to look for thin trees, finds more than 32."""
    frames = shutil.copytree(raw_drive, tmp_path / "frames")
    camera = frames / "camera.toml"
    camera.write_text(re.sub("diameter_m = .*", "diameter_m = [0.1, 0.3]", camera.read_text()))
    endpoint = free_endpoint()
    tap = Tap(endpoint)
    with (
        datagrams(lcm_url) as on_lcm,
        Client("zenoh_client.py", endpoint, "route", "bole/**") as router,
        Daemon(programs, frames, tmp_path / "boled.log", "--publish", "lcm,zenoh", "--set",
               f"lcm.url={lcm_url}", "--set", f'zenoh.connect=["{tap.endpoint}"]', "--set",
               "detect.mode=paper", "--set", "publish.min_score=0", "--set", f"camera.name={'c' * 16}", "--set",
               f"publish.robot={'r' * 64}"),
    ):
        assert eventually(lambda: len(router.lists(types)) > 5)
        sent = [on_lcm.recv(65536) for _ in range(10)]
        lists = [message for _, message in router.lists(types)]

    fullest = [message for message in lists if message.num_trees == types.tree_list_t.MAX_TREES]
    assert fullest and all(message.flags & types.tree_list_t.FLAG_TRUNCATED for message in fullest)
    on_lcm_bytes = max(len(data) for data in sent if b"BOLE_TREES\0" in data)
    report(lcm_bytes=on_lcm_bytes, zenoh_bytes=max(tap.sizes), list_bytes=len(fullest[0].encode()))
    assert len(fullest[0].encode()) < on_lcm_bytes <= MOST_BYTES
    assert len(fullest[0].encode()) < max(tap.sizes) <= MOST_BYTES


def hand_over(programs, raw_drive, log, types, lcm_url):
    """How both buses did in a few seconds of replay at 30 Hz, beside a third."""
    endpoint = free_endpoint()
    with (
        Client("zenoh_client.py", endpoint, "route", "bole/**") as router,
        Daemon(programs, raw_drive, log, "--pace", "rate:30", "--publish",
               "lcm,zenoh,jsonl:/dev/null", "--set", f"lcm.url={lcm_url}", "--set",
               f'zenoh.connect=["{endpoint}"]', "--set", "service.realtime_priority=10"),
    ):
        time.sleep(11)  # three lists above the 99th percentile
        buses = router.last_status(types).buses
    return [bus for bus in buses if bus.name != "jsonl"]


def test_lists_are_handed_over_at_once(programs, raw_drive, tmp_path, types, lcm_url, report):
    """The best of a few tries: others may hold the processors even against a realtime thread. What
    takes more than a millisecond waits for something; between the two it is the machine."""
    best = math.inf
    log = tmp_path / "boled.log"
    for _ in range(3):
        buses = hand_over(programs, raw_drive, log, types, lcm_url)
        for bus in buses:
            histogram = list(bus.handover_histogram)
            report(bus=bus.name, lists=bus.published, p50_us=bus.handover_p50_us,
                   p99_us=bus.handover_p99_us, histogram=histogram)
            assert sum(histogram) == bus.published > 0
        best = min(best, max(bus.handover_p99_us for bus in buses))
        if best <= 300:
            return
    if "CAP_SYS_NICE" in log.read_text():
        pytest.skip("without the right to realtime priority it depends on who else runs")
    if best <= 1000:
        pytest.skip(f"p99 is {best:.0f} us, not 300: this machine is too slow to tell why")
    pytest.fail("a bus' p99 was over 1 ms in every try")
