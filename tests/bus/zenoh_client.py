"""A Zenoh client that shares no code with ours: python3 zenoh_client.py ENDPOINT VERB KEY [COUNT].

get: prints the answer; subscribe: prints COUNT samples (or all), then ends; ignore: subscribes and
never reads, for 4 s; route: is the router at ENDPOINT, and prints all samples. Prints "ready" when
the subscription stands, then lines "key encoding hexadecimal-payload". ZENOH_SETTINGS may hold
more of zenoh's configuration, as a JSON object from keys to values.
"""

import itertools
import json
import os
import sys
import time

import zenoh


def show(sample):
    print(sample.key_expr, sample.encoding, sample.payload.to_bytes().hex(), flush=True)


def open_session(config, patience_s=10):
    """A client asks its endpoints once; who listens there may still be starting."""
    end = time.monotonic() + patience_s
    while True:
        try:
            return zenoh.open(config)
        except zenoh.ZError:
            if time.monotonic() > end:
                raise
        time.sleep(0.1)


def main():
    endpoint, verb, key = sys.argv[1:4]
    routes = verb == "route"
    config = zenoh.Config()
    config.insert_json5("mode", '"router"' if routes else '"client"')
    config.insert_json5(f"{'listen' if routes else 'connect'}/endpoints", f'["{endpoint}"]')
    config.insert_json5("scouting/multicast/enabled", "false")
    for setting, value in json.loads(os.environ.get("ZENOH_SETTINGS", "{}")).items():
        config.insert_json5(setting, json.dumps(value))
    with open_session(config) as session:
        if verb == "get":
            for reply in session.get(key, timeout=5):
                show(reply.ok)
            return
        capacity = 1 if verb == "ignore" else 1000
        subscriber = session.declare_subscriber(key, zenoh.handlers.FifoChannel(capacity))
        print("ready", flush=True)
        if verb == "ignore":
            time.sleep(4)
            os._exit(0)  # closing would wait for the reader
        for sample in itertools.islice(subscriber, *map(int, sys.argv[4:] or [sys.maxsize])):
            show(sample)


main()
