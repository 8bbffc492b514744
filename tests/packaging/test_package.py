"""The Debian packages: what they say of themselves, what they hold, and that it runs from where it is
unpacked."""

import gzip
import json
import re
import shutil
import subprocess

import pytest
from conftest import BUILD

pytestmark = pytest.mark.skipif(not (shutil.which("dpkg-deb") and shutil.which("cpack")),
                                reason="no dpkg-deb or no cpack")


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


@pytest.fixture(scope="module")
def packages(tmp_path_factory):
    """The packages by their names."""
    folder = tmp_path_factory.mktemp("packages")
    output("cpack", "--config", BUILD / "CPackConfig.cmake", "-B", folder)
    return {file.name.split("_")[0]: file for file in folder.glob("*.deb")}


@pytest.fixture(scope="module")
def root(packages, tmp_path_factory):
    """Where all of them are unpacked over each other."""
    folder = tmp_path_factory.mktemp("root")
    for file in packages.values():
        output("dpkg-deb", "-x", file, folder)
    return folder


def fields(package):
    return dict(line.split(": ", 1) for line in output("dpkg-deb", "-f", package).splitlines()
                if ": " in line and not line.startswith(" "))


def test_each_package_says_what_it_is_and_what_it_needs(packages):
    assert {"bole", "bole-tools", "bole-replay-codecs", "bole-dev"} <= set(packages)
    version = output(BUILD / "firmware_app/boled", "--version").split()[1]
    for name, package in packages.items():
        said = fields(package)
        assert (said["Package"], said["Version"]) == (name, version)
        assert said["Architecture"] == output("dpkg", "--print-architecture").strip()
        assert "@" in said["Maintainer"] and said["Description"]
        assert name == "bole-dev" or "libc6" in said["Depends"]
        assert name in ("bole", "bole-dev") or f"bole (= {version})" in said["Depends"]
    # A robot gets by without OpenCV and libcamera, and its tool without OpenCV's decoders.
    assert "liblcm1" in (daemon := fields(packages["bole"])["Depends"])
    assert "opencv" not in daemon and "libcamera" not in daemon
    assert "opencv-imgcodecs" not in fields(packages["bole-tools"])["Depends"]


def test_each_package_says_what_is_new_in_its_version(packages, root):
    for name, package in packages.items():
        changelog = gzip.decompress((root / f"usr/share/doc/{name}/changelog.gz").read_bytes())
        assert changelog.startswith(f"bole ({fields(package)['Version']})".encode())


def test_the_service_runs_what_is_installed(root):
    unit = (root / "usr/lib/systemd/system/boled.service").read_text()
    assert "ExecStart=/usr/bin/boled\n" in unit and "@" not in unit
    # What boled.toml says of files of the service.
    settings = (root / "usr/share/bole/boled.toml").read_text()
    assert "/var/lib/bole/lists.jsonl" in settings and "StateDirectory=bole\n" in unit
    assert "/var/cache/bole" in settings and "CacheDirectory=bole\n" in unit
    assert "/run/credentials/boled.service/" in settings and "LoadCredential=" in settings
    assert (root / "usr/lib/udev/rules.d/70-bole-cameras.rules").exists()
    assert (root / "etc/bole/camera").is_dir()
    assert not (root / "usr/local").exists()


def test_the_examples_name_where_the_types_are(root):
    examples = list((root / "usr/share/bole/examples").glob("subscribe_*"))
    named = {path for example in examples
             for path in re.findall("/usr/share/bole/[a-z]+", example.read_text())}
    assert named == {"/usr/share/bole/python", "/usr/share/bole/types"}
    assert all((root / path.lstrip("/")).is_dir() for path in named)


def test_the_scripts_of_the_installation_are_shell(packages, tmp_path):
    output("dpkg-deb", "-e", packages["bole"], tmp_path)
    for name in ["postinst", "prerm", "postrm"]:
        output("sh", "-n", tmp_path / name)


def test_files_are_readable_by_all_and_hold_no_debugging_symbols(root):
    programs = [root / "usr/bin/boled", root / "usr/bin/bolectl", *root.glob("usr/lib/bole/*.so")]
    assert len(programs) >= 3
    for program in programs:
        assert ".debug_info" not in output("readelf", "-S", program)
    for path in root.rglob("*"):
        assert path.stat().st_mode & 0o444 == 0o444, path


@pytest.mark.skipif(not shutil.which("help2man"), reason="no help2man")
@pytest.mark.parametrize(("page", "option"), [("man8/boled.8.gz", "--source"),
                                              ("man1/bolectl.1.gz", "eval")])
def test_each_program_has_a_manual(root, page, option):
    assert option in gzip.decompress((root / "usr/share/man" / page).read_bytes()).decode().replace(
        "\\-", "-")


def test_links_of_the_documentation_lead_somewhere(root):
    folder = root / "usr/share/doc/bole"
    pages = [folder / "README.md", *folder.glob("docs/*.md")]
    assert len(pages) > 1
    links = [(page, link) for page in pages
             for link in re.findall(r"\]\((?!https?:)([^)#]+)", page.read_text())]
    assert not [link for page, link in links if not (page.parent / link).exists()]


def test_programs_and_plug_ins_run_from_where_they_are_unpacked(root, tmp_path):
    boled, bolectl = root / "usr/bin/boled", root / "usr/bin/bolectl"
    # Through the example camera that is installed, not that of the source tree.
    output("env", "-C", tmp_path, bolectl, "sim", "--out", "drive", "--frames", "1", "--seed", "1")
    camera = tmp_path / "drive/camera.toml"
    lists = output(boled, "--camera", camera, "--source", f"replay:{tmp_path}/drive", "--pace",
                   "lockstep", "--publish", "jsonl:-")
    assert json.loads(lists)["num_trees"] > 0

    picture = tmp_path / "grey.ppm"  # which the programs do not read by themselves
    picture.write_bytes(b"P6 1280 960 255\n" + bytes([128]) * (3 * 1280 * 960))
    detected = json.loads(output(bolectl, "detect", "--camera", camera, picture))
    assert "error" not in detected

    if (root / "usr/lib/bole/bole_libcamera.so").exists():
        run = subprocess.run([bolectl, "doctor", "--camera", camera, "--source", "libcamera:none"],
                             capture_output=True, text=True)
        assert "libcamera:none is not there" in run.stdout


def test_a_program_of_ones_own_finds_trees_by_the_library(root, tmp_path):
    output(root / "usr/bin/bolectl", "sim", "--out", tmp_path / "drive", "--frames", "1", "--seed",
           "1", "--format", "grey")
    camera, frame = tmp_path / "drive/camera.toml", next((tmp_path / "drive").glob("*.grey"))
    build = tmp_path / "build"
    output("cmake", "-S", root / "usr/share/bole/examples/find_trees", "-B", build,
           f"-DCMAKE_PREFIX_PATH={root}/usr", "-DCMAKE_BUILD_TYPE=Release")
    output("cmake", "--build", build)
    trees = output(build / "find_trees", camera, frame).splitlines()
    assert trees and all(" rad, " in tree for tree in trees)
    longer = tmp_path / "longer.grey"
    longer.write_bytes(frame.read_bytes() + b"x")
    for wrong in (camera, longer):
        refused = subprocess.run([build / "find_trees", camera, wrong], capture_output=True, text=True)
        assert (refused.returncode, refused.stderr.count("\n")) == (1, 1)
