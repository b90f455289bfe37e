#!/usr/bin/env bash
# How memory and time of the whole program grow with the length of a recording: peaks of `imunoise wv`, `fit` and
# `diagnose` on simulated files, with 128 MiB of large arrays in memory. Needs 3 GB of disk, and as much in the cache
# folder meanwhile.
set -euo pipefail
export IMUNOISE_MEMORY_MIB=128
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

# measured NAME COMMAND...: peak of the process in MB, processor and wall time in s.
measured() {
  local name=$1 status=0
  shift
  python3 - "$name" "$@" << 'END' || status=$?
import os, subprocess, sys, time
start = time.monotonic()
with open(os.devnull, "w") as nowhere:
    child = subprocess.Popen(sys.argv[2:], stdout=nowhere, stderr=nowhere)
    _, status, used = os.wait4(child.pid, 0)
print(f"{sys.argv[1]:<44}{used.ru_maxrss / 1024:8.0f} MiB"
      f"{used.ru_utime + used.ru_stime:9.2f} s of processors{time.monotonic() - start:9.2f} s")
sys.exit(status != 0)
END
  return $status
}

model="WN(sigma2=1e-6) + RW(gamma2=1e-14)"
for samples in 1000000 10000000 100000000; do
  "$program" simulate --model "$model" --rate 200 --samples $samples --unit rad/s --out long.npy > /dev/null 2>&1
  measured "wv, $samples samples" "$program" wv long.npy
  measured "wv --robust 0.6, $samples samples" "$program" wv long.npy --robust 0.6
  measured "wv --allan, $samples samples" "$program" wv long.npy --allan
  measured "fit, $samples samples" "$program" fit long.npy --model "WN + RW"
done
for samples in 100000 1000000 4000000; do
  "$program" simulate --model "$model + witness(temperature, coefficient=1e-6)" --witness "temperature[K]: RW(gamma2=1e-6)" \
    --witness "supply[V]: WN(sigma2=1e-4)" --rate 200 --samples $samples --replicates 6 --channel gyro_x --unit rad/s \
    --out run.h5 > /dev/null 2>&1
  measured "diagnose, 6 x $samples x 3 samples" "$program" diagnose run_?.h5 --channel gyro_x --model "WN + RW"
done
