"""Trees from LCM: python3 -m venv v && v/bin/pip install lcm;
PYTHONPATH=/usr/share/bole/python v/bin/python subscribe_lcm.py
(/usr/local/share/bole/python where bole was installed without its package)"""

import lcm

from bole import status_t, tree_list_t


def on_message(channel, data):
    try:
        if channel == "BOLE_STATUS":
            status = status_t.decode(data)
            print("state", status.state, status.state_reason, status.degraded_reason)
            return
        trees = tree_list_t.decode(data)
    except Exception as error:  # a foreign or newer type: name it and go on
        return print(channel, "is not of this version:", repr(error))
    if trees.flags & tree_list_t.FLAG_DEGRADED:
        print("the camera cannot see well: no tree listed means nothing")
    for tree in trees.trees:
        print(f"#{tree.id}: {tree.bearing:+.3f} rad, {tree.range:.2f} +- {tree.range_sigma:.2f} m")


bus = lcm.LCM("udpm://239.255.76.67:7667?ttl=0")
bus.subscribe("BOLE_.*", on_message)
while True:
    bus.handle()
