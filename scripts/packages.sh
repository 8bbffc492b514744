# Debian packages that building and testing need; sourced by demo, test and .ci/run.
# shellcheck shell=bash
build_packages=(
  build-essential ccache cmake file git help2man ninja-build pkg-config
  libbenchmark-dev libcamera-dev libcli11-dev libgmock-dev libgtest-dev libhwy-dev libjpeg-dev liblcm-bin
  liblcm-dev libopencv-dev libpng-dev libspdlog-dev libsystemd-dev libtomlplusplus-dev
  libturbojpeg0-dev libyaml-cpp-dev nlohmann-json3-dev zlib1g-dev
)
check_packages=(clang-format clang-tidy iproute2 openssl python3-venv)
# The core's check on arm64: scripts/arm64-check.
arm64_packages=(g++-aarch64-linux-gnu qemu-user)
# The hardware-in-the-loop rig: the guest runs on the host's own root, so what it uses is installed
# here, and the kernel is fetched without being installed.
hil_packages=(
  busybox-static cpio iproute2 kmod libcamera-ipa libcamera-tools python3 qemu-system-x86 systemd
  udev v4l-utils xz-utils
)

# install_packages name...: installs those that are missing; silent when all are there.
install_packages() {
  local missing=()
  for package in "$@"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' ||
      missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  local as_root=()
  [ "$(id -u)" -eq 0 ] || as_root=(sudo)
  echo "installing: ${missing[*]}"
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}
