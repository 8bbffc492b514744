"""Settings of Zenoh that cannot work, those that may yet, and who is let in."""

import contextlib
import socket
import subprocess
import time

import pytest
from processes import Client, Daemon, bus_summary, eventually, free_endpoint, replay_summary


def openssl(folder, *words):
    subprocess.run(["openssl", *words], cwd=folder, check=True, capture_output=True)


@pytest.fixture(scope="session")
def certificates(tmp_path_factory):
    """NAME.pem and NAME.key: an authority, and two for 127.0.0.1 that it signed."""
    folder = tmp_path_factory.mktemp("certificates")
    key = ["-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "2"]
    for name, more in [
        ("ca", []),
        ("daemon", ["-CA", "ca.pem", "-CAkey", "ca.key"]),
        ("planner", ["-CA", "ca.pem", "-CAkey", "ca.key"]),
    ]:
        extensions = ["subjectAltName=IP:127.0.0.1", "basicConstraints=CA:FALSE"] if more else []
        openssl(folder, "req", "-x509", *key, "-subj", f"/CN={name}", "-keyout", f"{name}.key", "-out",
                f"{name}.pem", *more, *(w for text in extensions for w in ("-addext", text)))
    return folder


def tls(folder, name):
    return [word for key, file in [("ca", "ca.pem"), ("certificate", f"{name}.pem"),
                                   ("private_key", f"{name}.key")]
            for word in ("--set", f'zenoh.tls.{key}="{folder / file}"')]


def refusal(run):
    """The one line of a daemon that did not start; a warp table that was built may be told before."""
    assert run.returncode == 2
    (line,) = (line for line in run.stderr.splitlines() if " info: " not in line)
    return line


@pytest.mark.parametrize("settings, named", [
    (['zenoh.connect=["127.0.0.1:7447"]'], ["zenoh.connect", "127.0.0.1:7447", "tcp/HOST:PORT"]),
    (['zenoh.connect=["udp/127.0.0.1:7447"]'], ["zenoh.connect", "udp/127.0.0.1:7447", "protocol"]),
    (['zenoh.listen=["tcp/127.0.0.1:77777"]'], ["zenoh.listen", "77777"]),
    (['zenoh.listen=["tls/127.0.0.1:0"]'], ["zenoh.tls.certificate"]),
    (['zenoh.mode="broker"'], ["zenoh.mode", "broker"]),
    (['zenoh.mode="client"'], ["zenoh.connect"]),
    (['zenoh.tls.ca="/nonexistent.pem"'], ["zenoh.tls.ca", "/nonexistent.pem"]),
    (['zenoh.config_file="/nonexistent.json5"'], ["zenoh.config_file", "/nonexistent.json5"]),
])
def test_what_cannot_work_is_one_line_and_exit_code_2(boled, raw_drive, settings, named):
    options = [word for setting in settings for word in ("--set", setting)]
    run = boled("--publish", "zenoh", *options, camera=raw_drive / "camera.toml",
                source=f"replay:{raw_drive}")
    line = refusal(run)
    assert all(text in line for text in named), line


def test_a_port_in_use_is_waited_for_and_the_other_bus_goes_on(
    programs, raw_drive, tmp_path, types, lcm_url
):
    endpoint = free_endpoint()
    buses = ["--publish", "lcm,zenoh", "--set", f"lcm.url={lcm_url}", "--set",
             f'zenoh.listen=["{endpoint}"]']
    with (
        socket.create_server(("127.0.0.1", int(endpoint.rpartition(":")[2]))) as other,
        Client("lcm_client.py", lcm_url, "BOLE_.*") as lcm,
        Daemon(programs, raw_drive, tmp_path / "boled.log", *buses) as boled,
    ):
        def zenoh_health():
            status = lcm.last_status(types)
            return status and next(bus for bus in status.buses if bus.name == "zenoh")

        assert eventually(lambda: (bus := zenoh_health()) and bus.failed > 0)
        assert f"{endpoint}: the port is in use" in zenoh_health().last_error
        assert not zenoh_health().healthy and lcm.lists(types)
        other.close()
        assert eventually(lambda: zenoh_health().published > 0)
        assert zenoh_health().healthy
        assert boled.stop().count("the port is in use") == 1


def test_the_default_port_in_use_is_an_error_with_a_remedy(boled, raw_drive):
    with socket.socket() as other:
        with contextlib.suppress(OSError):  # whoever has it already will do
            other.bind(("127.0.0.1", 7447))
            other.listen()
        run = boled("--publish", "zenoh", camera=raw_drive / "camera.toml",
                    source=f"replay:{raw_drive}")
    assert run.returncode == 0
    (line,) = (line for line in run.stderr.splitlines() if "the port is in use" in line)
    assert "zenoh.listen" in line and 'zenoh.connect=["tcp/127.0.0.1:7447"]' in line


def test_a_private_key_of_another_is_one_line_and_exit_code_2(boled, raw_drive, certificates):
    run = boled("--publish", "zenoh", "--set", f'zenoh.listen=["{free_endpoint("tls")}"]',
                *tls(certificates, "daemon"), "--set",
                f'zenoh.tls.private_key="{certificates / "planner.key"}"',
                camera=raw_drive / "camera.toml", source=f"replay:{raw_drive}")
    assert "zenoh.tls.private_key" in (line := refusal(run)) and "does not fit" in line


def test_an_endpoint_that_nobody_serves_is_told_once_and_the_other_bus_goes_on(
    programs, raw_drive, tmp_path, types, lcm_url
):
    endpoint = free_endpoint()
    with (
        Client("lcm_client.py", lcm_url, "BOLE_.*") as lcm,
        Daemon(programs, raw_drive, tmp_path / "boled.log", "--publish", "lcm,zenoh", "--set",
               f"lcm.url={lcm_url}", "--set", f'zenoh.connect=["{endpoint}"]') as boled,
    ):
        time.sleep(3)
        status = lcm.last_status(types)
        log = boled.stop()
        received = len(lcm.lists(types))
    health = {bus.name: bus for bus in status.buses}
    assert health["lcm"].healthy and not health["zenoh"].healthy
    assert endpoint in health["zenoh"].last_error
    assert log.count("error: ") == 1
    assert log.count("Connection refused") == 1
    _, lists, _ = replay_summary(log)
    assert bus_summary(log, "lcm") == (lists, 0, 0) and lists - received <= 1
    published, overwritten, failed = bus_summary(log, "zenoh")
    assert published == 0 and overwritten + failed == lists


def test_mutual_tls_refuses_who_has_no_certificate_and_says_so(
    programs, bolectl, raw_drive, tmp_path, types, certificates
):
    endpoint = free_endpoint("tls")
    ca = {"transport/link/tls/root_ca_certificate": str(certificates / "ca.pem")}
    planner = ca | {
        "transport/link/tls/enable_mtls": True,
        "transport/link/tls/connect_certificate": str(certificates / "planner.pem"),
        "transport/link/tls/connect_private_key": str(certificates / "planner.key"),
    }
    with Daemon(programs, raw_drive, tmp_path / "boled.log", "--publish", "zenoh", "--set",
                f'zenoh.listen=["{endpoint}"]', *tls(certificates, "daemon"), "--set",
                "zenoh.tls.mutual=true") as boled:
        with Client("zenoh_client.py", endpoint, "subscribe", "bole/**", settings=planner) as admitted:
            assert eventually(lambda: admitted.lists(types))
        config = tmp_path / "planner.toml"
        config.write_text("[zenoh.tls]\nmutual = true\n" + "".join(
            f'{key} = "{certificates / file}"\n' for key, file in
            [("ca", "ca.pem"), ("certificate", "planner.pem"), ("private_key", "planner.key")]))
        listened = bolectl("listen", "--zenoh", endpoint, "--config", config, "--count", "1")
        assert listened.returncode == 0 and "bole/robot/" in listened.stdout, listened.stderr
        stranger = Client("zenoh_client.py", endpoint, "subscribe", "bole/**", settings=ca)
        try:
            assert eventually(lambda: "peer sent no certificates" in boled.log()), boled.log()
            time.sleep(2)
            assert not stranger.lines
            log = boled.stop()
        finally:
            stranger.close()
    assert 1 <= log.count("peer sent no certificates") <= 3  # counted, not repeated
