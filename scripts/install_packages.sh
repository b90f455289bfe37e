#!/usr/bin/env bash
# Installs what imunoise needs from Debian 12's own packages, and nothing that is there already.
#
#   bash scripts/install_packages.sh build   to build the program
#   bash scripts/install_packages.sh test    to build and run every test as well
#   bash scripts/install_packages.sh bench   to build and run the benchmarks
#   bash scripts/install_packages.sh package to make the Debian package
#   bash scripts/install_packages.sh hil     to run the programs on a real kernel, in virtual machines
#   bash scripts/install_packages.sh slow    to run the tests labelled slow as well
set -euo pipefail

build_packages=(
  g++ cmake ninja-build ccache
  libeigen3-dev    # matrices
  libnlopt-dev     # search of the nonlinear parameters
  libboost-dev     # headers only: distributions, random numbers
  libtbb-dev       # threads
  libfmt-dev libexpected-dev
  libprotobuf-dev protobuf-compiler
  libhdf5-dev libdeflate-dev  # recordings
  libcli11-dev     # the command line
  libcurl4-openssl-dev  # the command line as a client of the daemon
  libtomlplusplus-dev libspdlog-dev libsystemd-dev  # the daemon
  libusb-1.0-0-dev pkg-config  # sensors behind USB bridges
  libserialport-dev  # the driver xsens
  libiio-dev         # the driver iio
  libsoci-dev        # the catalogue of recordings
  liblz4-dev libzstd-dev libbz2-dev zlib1g-dev  # packed bags and files
  libsqlite3-dev     # bags of ROS 2
  python3-dev pybind11-dev python3-numpy  # the Python module
)
# The page is built with npm, and tested in a browser; those of other sources do as well.
command -v npm > /dev/null || build_packages+=(nodejs npm)

test_packages=(
  libgtest-dev nlohmann-json3-dev
  clang libclang-rt-14-dev       # fuzzing
  clang-format clang-tidy
  umockdev libumockdev-dev       # USB devices that are not there
  python3-h5py python3-xarray python3-h5netcdf python3-scipy python3-matplotlib  # other programs open our files, and write theirs
  lz4 zstd bzip2 python3-rosbag python3-sensor-msgs  # other programs write bags
  postgresql                     # the catalogue of several benches
  zsh                            # its completion
)
command -v chromium > /dev/null || test_packages+=(chromium)
bench_packages=(libbenchmark-dev time jq)
package_packages=(dpkg-dev file lintian)
hil_packages=(
  qemu-system-x86 busybox-static cpio kmod  # the machine
  iproute2 dmsetup e2fsprogs xfsprogs  # its interfaces and disks
  udev                                 # tells libusb of devices
  python3-h5py                         # reads what was recorded
  mmdebstrap genext2fs uidmap          # a Debian with systemd
)
slow_packages=(
  slurm-wlm munge  # batches
  debootstrap systemd-container  # an empty Debian for the package
)

case "${1-}" in
  build) wanted=("${build_packages[@]}") ;;
  test) wanted=("${build_packages[@]}" "${test_packages[@]}") ;;
  bench) wanted=("${build_packages[@]}" "${bench_packages[@]}") ;;
  package) wanted=("${build_packages[@]}" "${package_packages[@]}") ;;
  hil) wanted=("${hil_packages[@]}") ;;
  slow) wanted=("${build_packages[@]}" "${test_packages[@]}" "${package_packages[@]}" "${slow_packages[@]}" "${hil_packages[@]}") ;;
  *)
    echo "usage: $0 build|test|bench|package|hil|slow" >&2
    exit 2
    ;;
esac

if ! command -v dpkg-query > /dev/null || ! command -v apt-get > /dev/null; then
  echo "This is not a Debian system. Provide what these packages hold: ${wanted[*]}" >&2
  exit 0 # they may be there; CMake says what is not
fi

missing=()
for package in "${wanted[@]}"; do
  status=$(dpkg-query --show --showformat='${db:Status-Status}' "$package" 2> /dev/null || true)
  [[ $status == installed* ]] || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
  exit 0
fi

as_root=()
if ((EUID != 0)); then
  if ! command -v sudo > /dev/null || { ! sudo -n true 2> /dev/null && [[ ! -t 0 ]]; }; then
    echo "Missing packages, and neither root nor sudo to install them; as root: apt-get install ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
echo "Installing ${#missing[@]} packages: ${missing[*]}"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -qq > "$log" 2>&1 ||
  echo "apt-get update failed; trying with the package lists at hand" >&2
if ! "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -y -qq --no-install-recommends "${missing[@]}" > "$log" 2>&1; then
  grep -E '^(E|Err):' "$log" | head -n 3 >&2 || true
  if grep -q 'Unable to locate package' "$log"; then
    echo "These packages are Debian 12's: is this Debian 12, and has apt-get update worked?" >&2
  elif grep -qE 'Could not resolve|Failed to fetch|Unable to connect' "$log"; then
    echo "No network: connect this machine, or install from a mirror at hand: apt-get install ${missing[*]}" >&2
  elif grep -qE 'No space left|enough free space' "$log"; then
    echo "The disk is full: make room in / and /var, then run this again" >&2
  else
    echo "Install them by hand, then run this again: apt-get install ${missing[*]}" >&2
  fi
  exit 1
fi
