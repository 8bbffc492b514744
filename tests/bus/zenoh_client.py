"""A Zenoh client that shares no code with ours: python3 zenoh_client.py ENDPOINT VERB KEY [COUNT].

get: prints the answer; subscribe: prints COUNT samples, then ends; ignore: subscribes and never
reads, for 4 s. Prints "ready" when the subscription stands, then lines "key encoding hexadecimal-payload".
"""

import os
import sys
import time

import zenoh


def show(sample):
    print(sample.key_expr, sample.encoding, sample.payload.to_bytes().hex(), flush=True)


def main():
    endpoint, verb, key = sys.argv[1:4]
    config = zenoh.Config()
    config.insert_json5("mode", '"client"')
    config.insert_json5("connect/endpoints", f'["{endpoint}"]')
    config.insert_json5("scouting/multicast/enabled", "false")
    with zenoh.open(config) as session:
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
        for _ in range(int(sys.argv[4])):
            show(subscriber.recv())


main()
