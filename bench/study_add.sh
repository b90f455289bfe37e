#!/usr/bin/env bash
# `imunoise study add` of unforeseen terms, the whole program, on six replicates of a million samples beside
# a temperature that was looked at before: median wall time of nine.
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

"$program" simulate --model "WN(sigma2=2.5e-7) + AR1(sigma2=4e-11, phi=0.998) + RW(gamma2=5e-14)" \
  --rate 100 --samples 1000000 --replicates 6 --seed 1 --unit rad/s --out gyro.npy > /dev/null
"$program" simulate --model "WN(sigma2=1e-4) + RW(gamma2=1e-8)" \
  --rate 100 --samples 1000000 --replicates 6 --seed 2 --unit K --out heat.npy > /dev/null
# A wave at 13.7 Hz that no model has, and both channels in one file.
python3 - << 'END'
import array, json, math
channels = [{"name": "gyro_x", "units": "rad/s"}, {"name": "temperature", "units": "K"}]
wave = [3e-6 * math.sin(2 * math.pi * 0.137 * t) for t in range(1000)]
for k in range(1, 7):
    both = array.array("d", bytes(16 * 1000000))
    for c, name in enumerate(("gyro", "heat")):
        values = array.array("d")
        with open(f"{name}_{k}.npy", "rb") as file:
            file.seek(-8 * 1000000, 2)
            values.fromfile(file, 1000000)
        if c == 0:
            values = array.array("d", (x + wave[t % 1000] for t, x in enumerate(values)))
        both[c::2] = values
    with open(f"run{k}.f64", "wb") as file:
        both.tofile(file)
    json.dump({"rate_hz": 100, "channels": channels}, open(f"run{k}.f64.json", "w"))
END

"$program" study new seen.study run?.f64 --channel gyro_x --model "WN + AR1 + RW" > /dev/null
cp seen.study one.study
"$program" study add one.study "witness(temperature)" > /dev/null
for term in "line(f=13.7)" "line(f=13.7, harmonics=3)" QN ramp "step(replicate=2, t=5000)" \
  "witness(temperature)" "witness(temperature, lag=300)" AR1 "modulated(temperature)" telegraph; do
  for _ in 1 2 3 4 5 6 7 8 9; do
    cp seen.study one.study
    /usr/bin/time --format %e "$program" study add one.study "$term" 2>&1 > /dev/null | tail -n 1
  done | sort -n | awk -v term="$term" 'NR == 5 { printf "%-32s %s s\n", term, $1 }'
done
