#!/usr/bin/env bash
# The programs of a build on a real kernel, in virtual machines.
#
#   bash tests/hil/run.sh BUILD_FOLDER [SCENARIO...]   all scenarios, or some of them: disk, systemd, iio, usb, serial, can
#
# Exit status 77: this system has no package manager to take QEMU and a kernel from.
set -euo pipefail
build=$(realpath "$1")
shift
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source=$(realpath "$here/../..")
# shellcheck source=tests/hil/machine.sh
source "$here/machine.sh"

command -v apt-get > /dev/null || { echo "SKIPPED: this is not a Debian system"; exit 77; }
command -v qemu-system-x86_64 > /dev/null || bash "$source/scripts/install_packages.sh" hil
kernels=$build/hil/kernel
scratch=$build/hil
mkdir -p "$scratch"
kernel "$kernels"
first_files "$kernels" "$scratch/first.cpio"

can() {
  boot can 400 -object can-bus,id=bus -device kvaser_pci,canbus=bus -device kvaser_pci,canbus=bus
}

usb() { boot usb 600; }
iio() { boot iio 300; }

# order COMMAND: to QEMU's monitor.
order() {
  python3 -c 'import socket, sys; s = socket.socket(socket.AF_UNIX); s.connect(sys.argv[1]); s.sendall((sys.argv[2] + "\n").encode()); s.recv(100); __import__("time").sleep(0.5)' \
    "$scratch/monitor" "$1"
}

# The cable of the sensor: it follows what the scenario says.
cable() {
  until grep -q "UNPLUG THE SENSOR" "$scratch/serial.log" 2> /dev/null; do sleep 0.2; done
  order "device_del converter"
  until grep -q "PLUG THE SENSOR IN" "$scratch/serial.log"; do sleep 0.2; done
  order "device_add usb-serial,chardev=sensor,id=converter"
}

serial() {
  local port=$scratch/sensor helpers=() passed=0
  rm -f "$scratch/serial.log"
  "$build/imunoise" emulate --device xsens --at "$port" > "$scratch/emulate.txt" 2>&1 &
  helpers+=($!)
  for _ in $(seq 50); do [[ -e $port ]] && break || sleep 0.2; done
  cable &
  helpers+=($!)
  boot serial 300 -device piix3-usb-uhci -chardev serial,id=sensor,path="$(realpath "$port")" \
    -device usb-serial,chardev=sensor,id=converter -monitor unix:"$scratch/monitor",server=on,wait=off || passed=1
  kill "${helpers[@]}" 2> /dev/null || true
  return $passed
}

disk() {
  truncate -s 0 "$scratch/disk.img"
  truncate -s 400M "$scratch/disk.img"
  boot disk 3000 -drive file="$scratch/disk.img",format=raw,if=virtio,cache=unsafe
}

# Two revisions of the package, made by scripts/package.sh unless they are there.
systemd() {
  local revision package needs
  mkdir -p "$scratch/packages"
  for revision in 1 2; do
    package=$scratch/packages/$revision.deb
    [[ -e $package ]] && continue
    bash "$source/scripts/package.sh" "$revision" || return
    cp "$source/build/package/package/"*"-${revision}_"*.deb "$package"
  done
  needs=$(dpkg-deb --field "$scratch/packages/1.deb" Depends | tr ',' '\n' | sed -e 's/[(|].*//' -e 's/ //g')
  # shellcheck disable=SC2086
  debian "$scratch/debian.img" systemd-sysv dbus udev kmod curl $needs
  more="DISK=/dev/vda systemd.mask=serial-getty@ttyS0.service" boot systemd 900 \
    -drive file="$scratch/debian.img",format=raw,if=virtio,snapshot=on \
    -device piix3-usb-uhci -chardev null,id=nothing -device usb-serial,chardev=nothing,always-plugged=on
}

# told SCENARIO: runs it, its name before each line.
told() {
  local begin=$SECONDS outcome=0
  "$1" 2>&1 | sed -u "s/^/$1: /" || outcome=$?
  echo "$1: $((SECONDS - begin)) s"
  return $outcome
}

# Two at a time: a guest keeps one processor busy. The longest begins first.
(($# > 0)) || set -- disk systemd iio usb serial can
declare -A running=()
failed=()
# ended: waits for one of them.
ended() {
  local which
  wait -n -p which || failed+=("${running[$which]}")
  unset "running[$which]"
}
begin=$SECONDS
for scenario in "$@"; do
  ((${#running[@]} < 2)) || ended
  told "$scenario" &
  running[$!]=$scenario
done
while ((${#running[@]} > 0)); do ended; done
echo "all: $((SECONDS - begin)) s"
if ((${#failed[@]} > 0)); then
  echo "FAILED: ${failed[*]}"
  exit 1
fi
