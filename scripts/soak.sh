#!/usr/bin/env bash
# A day in the life of imunoised in a quarter of an hour: three emulated devices with random faults, one of them
# accelerated, recorded by the daemon, which is killed (SIGKILL) at random times of the second half. In the end
# every recording is verified, losses are compared with the faults, and memory over time is drawn.
#
#   bash scripts/soak.sh [--hours 24] [--speed 100] [--kills 8] [--seed 1] [--build FOLDER] [--out FOLDER]
#
# --build: a build tree to take the programs from; else preset demo is built. Exit status 1 when anything was lost.
# docs/soak.md says what is checked, and what was measured.
set -euo pipefail
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

hours=24 speed=100 kills=8 seed=1 build="" out=build/soak
while (($# > 0)); do
  case $1 in
    --hours) hours=$2 ;;
    --speed) speed=$2 ;;
    --kills) kills=$2 ;;
    --seed) seed=$2 ;;
    --build) build=$2 ;;
    --out) out=$2 ;;
    *)
      echo "usage: $0 [--hours H] [--speed X] [--kills N] [--seed S] [--build FOLDER] [--out FOLDER]" >&2
      exit 2
      ;;
  esac
  shift 2
done

bash scripts/install_packages.sh bench
if [[ -z $build ]]; then
  build=build/demo
  configure demo
  compile demo imunoise imunoised imunoise_plugins
fi
out=$(realpath -m "$out")
rm -rf "$out"
mkdir -p "$out"

total=$((hours * 3600 / speed)) # seconds of ours
length=$((2 * 3600 / speed))    # of a replicate, two hours of the accelerated device
RANDOM=$seed

# faults SAMPLES COUNT KINDS...: as a list of TOML, one fault in each of COUNT equal parts of SAMPLES.
faults() {
  local samples=$1 count=$2 part text=""
  shift 2
  part=$((samples / count))
  for ((i = 0; i < count; ++i)); do
    local kind=${*:$((RANDOM % $# + 1)):1}
    local at=$((i * part + part / 4 + (RANDOM * 32768 + RANDOM) % (part / 2)))
    case $kind in
      loss | bit_error) text+="\"$kind(sample=$at)\", " ;;
      *) text+="\"$kind(sample=$at, count=$((RANDOM % 200 + 10)))\", " ;;
    esac
  done
  echo "[$text]"
}

cat > "$out/soak.toml" << CAMPAIGN
name = "soak"
folder = "$out/recordings"
length = "$length s"
replicates = $((total / length + kills + 10))
reserve = "100 MB"
[[device]]
name = "adis16405"
driver = "emulated"
options.device = "adis16405"
options.speed = $speed
options.seed = $seed
options.fault = $(faults $((length * speed * 102)) 24 loss stall late unplug)
[[device]]
name = "mti"
driver = "emulated"
options.device = "xsens"
options.rate = 200
options.seed = $seed
options.fault = $(faults $((length * 200)) 6 loss bit_error unplug)
[[device]]
name = "can"
driver = "emulated"
options.device = "can"
options.rate = 200
options.seed = $seed
options.fault = $(faults $((length * 200)) 6 loss unplug)
CAMPAIGN

# When to kill: one moment in each equal part of the second half.
moments=()
for ((i = 0; i < kills; ++i)); do
  part=$((total / 2 / kills))
  moments+=($((total / 2 + i * part + RANDOM % (part > 10 ? part - 10 : 1) + 5)))
done

now_ms() { echo $(($(date +%s%N) / 1000000)); }
daemon=""
start_daemon() {
  "$build/imunoised" "$out/soak.toml" >> "$out/daemon.log" 2>&1 &
  daemon=$!
}
trap '[[ -z $daemon ]] || kill "$daemon" 2> /dev/null || true' EXIT

echo "seed $seed: $hours hours at $speed times real time are $total s; SIGKILL after: ${moments[*]-} s"
begin=$(now_ms)
start_daemon
while (($(now_ms) - begin < total * 1000)); do
  second=$((($(now_ms) - begin) / 1000))
  if ((${#moments[@]} > 0 && second >= moments[0])); then
    moments=("${moments[@]:1}")
    kill -KILL "$daemon"
    echo "$second $(now_ms)" >> "$out/kills.txt"
    wait "$daemon" 2> /dev/null || true
    sleep "$((RANDOM % 3))"
    start_daemon
  fi
  own=$(awk '/^(RssAnon|VmSwap)/ {sum += $2} END {print sum}' "/proc/$daemon/status" 2> /dev/null || true)
  if [[ -z $own ]]; then
    echo "imunoised ended unexpectedly; the end of $out/daemon.log:" >&2
    tail -n 20 "$out/daemon.log" >&2
    exit 1
  fi
  echo "$second $own $daemon" >> "$out/memory.txt"
  sleep 1
done
kill -TERM "$daemon"
wait "$daemon"
daemon=""

bash scripts/judge_soak.sh "$build/imunoise" "$out" "$speed"
