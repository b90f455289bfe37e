#!/usr/bin/env bash
# The whole way of samples, from replayed devices through recorder, journals and chunk files: 30 million values as
# fast as possible, and 64 devices of ten channels at 1 kHz in real time. Wall and processor time of the program.
set -euo pipefail
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/../scripts/common.sh"

bash scripts/install_packages.sh bench
echo "Building imunoise ..."
configure release
compile release imunoise
program=$PWD/build/release/imunoise
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

# counts NAME ROWS: ten channels of 16-bit counts at 1 kHz, white noise of about 19 counts.
counts() {
  python3 - "$1" "$2" << 'END'
import array, json, random, sys
name, rows = sys.argv[1], int(sys.argv[2])
random.seed(1)
with open(name, "wb") as out:
    for begin in range(0, rows, 10000):
        piece = random.randbytes(10 * 10000)
        array.array("h", [(b & 63) - 32 for b in piece]).tofile(out)
channels = [{"name": f"c{i}"} for i in range(10)]
json.dump({"rate_hz": 1000, "channels": channels}, open(name + ".json", "w"))
END
}

# timed COMMAND...: its wall and processor time.
timed() {
  /usr/bin/time --format '%e s wall, %U s user, %S s system, %M KiB' "$@" 2>&1 > /dev/null | tail -n 1
}

counts fast.i16 3000000
echo "30 million values as fast as possible:"
for _ in 1 2 3; do
  rm -rf fast
  timed "$program" record fast --device "replay file=fast.i16 speed=0"
done
du --bytes --summarize fast | awk '{ printf "%.2f bytes a value\n", $1 / 30e6 }'

counts slow.i16 30000
devices=()
for _ in {1..64}; do devices+=(--device "replay file=slow.i16 speed=1"); done
echo "64 devices, 20 s in real time:"
timed "$program" record slow "${devices[@]}" --duration 20
"$program" verify slow | tail -n 1
