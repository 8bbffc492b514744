"""Trees from Zenoh: python3 -m venv v && v/bin/pip install eclipse-zenoh;
PYTHONPATH=/usr/share/bole/python v/bin/python subscribe_zenoh.py [tcp/127.0.0.1:7447]
(/usr/local/share/bole/python where bole was installed without its package)"""

import sys

import zenoh

from bole import status_t, tree_list_t

endpoint = sys.argv[1] if len(sys.argv) > 1 else "tcp/127.0.0.1:7447"
config = zenoh.Config()
config.insert_json5("mode", '"client"')
config.insert_json5("connect/endpoints", f'["{endpoint}"]')
config.insert_json5("connect/timeout_ms", "-1")  # boled may start later
with zenoh.open(config) as session:
    subscriber = session.declare_subscriber("bole/*/*/*")
    for sample in subscriber:
        key, data = str(sample.key_expr), sample.payload.to_bytes()
        try:
            message = (status_t if key.endswith("/status") else tree_list_t).decode(data)
        except Exception as error:  # a foreign or newer type: name it and go on
            print(key, "is not of this version:", repr(error))
            continue
        if key.endswith("/status"):
            print(key, "state", message.state, message.state_reason, message.degraded_reason)
            continue
        if message.flags & tree_list_t.FLAG_DEGRADED:
            print(key, "the camera cannot see well: no tree listed means nothing")
        for tree in message.trees:
            print(f"#{tree.id}: {tree.bearing:+.3f} rad, {tree.range:.2f} +- {tree.range_sigma:.2f} m")
