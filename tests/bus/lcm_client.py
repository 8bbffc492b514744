"""An LCM subscriber that shares no code with ours: python3 lcm_client.py URL CHANNEL.

Prints "ready" when it listens, then a line "channel hexadecimal-payload" for each message.
"""

import sys

import lcm


def main():
    url, channel = sys.argv[1:]
    bus = lcm.LCM(url)
    subscription = bus.subscribe(
        channel, lambda name, data: print(name, data.hex(), flush=True)
    )
    subscription.set_queue_capacity(0)
    print("ready", flush=True)
    while True:
        bus.handle()


main()
