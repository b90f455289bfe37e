#!/usr/bin/env bash
# Fuzzes parsers of outside bytes, each for as long as you say, and tells what was run. Inputs that reach new branches
# are kept in build/asan/fuzz/NAME, so that the next call goes on from there.
#
#   bash scripts/fuzz.sh [--seconds 3600] [--runs N] [NAME...]     all parsers, or some of them: mcap, hdf5, ...
#
# --runs: ends a parser sooner, after so many runs. The last table has, for each parser: runs, seconds, branches
# reached, inputs kept. Exit status 1 when a parser failed: the input lies in build/asan/fuzz/NAME.crash/.
set -euo pipefail
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

seconds=3600 runs=-1
while (($# > 0)); do
  case $1 in
    --seconds) seconds=$2 ;;
    --runs) runs=$2 ;;
    --*)
      echo "usage: $0 [--seconds S] [--runs N] [NAME...]" >&2
      exit 2
      ;;
    *) break ;;
  esac
  shift 2
done

bash scripts/install_packages.sh test
configure asan
compile asan fuzzers
programs=build/asan/tests/fuzz
kept=build/asan/fuzz
mkdir -p "$kept"
names=("$@")
if (($# == 0)); then
  mapfile -t names < <(find "$programs" -maxdepth 1 -name 'fuzz_*' -type f | sed 's/.*fuzz_//' | sort)
fi

# fuzz NAME: one parser.
fuzz() {
  local name=$1 words
  mkdir -p "$kept/$name" "$kept/$name.crash"
  words=$(find tests/fuzz -name "$name.dict" -printf '-dict=%p')
  # shellcheck disable=SC2086
  "$programs/fuzz_$name" "$kept/$name" $words -max_total_time="$seconds" -runs="$runs" -rss_limit_mb=1024 -timeout=10 \
    -len_control=10 -artifact_prefix="$kept/$name.crash/" -print_final_stats=1 > "$kept/$name.log" 2>&1 || echo "FAILED: $name, see $kept/$name.log"
}

# told NAME: its row of the table.
told() {
  local log=$kept/$1.log
  awk -v name="$1" -v kept="$(find "$kept/$1" -type f | wc -l)" '
    / cov: / {for (i = 1; i < NF; ++i) if ($i == "cov:") branches = $(i + 1)}
    /^Done / {runs = $2; seconds = $5}
    /^stat::number_of_executed_units/ {runs = $2}
    END {printf "%-16s %10d %8s %8d %8d\n", name, runs, seconds, branches, kept}' "$log"
}

export TMPDIR=/dev/shm  # some parsers want a file: in memory it is five times faster
export -f fuzz
export programs kept seconds runs
printf '%s\n' "${names[@]}" | xargs -P "$jobs" -I{} bash -c 'fuzz {}' | tee "$kept/failed"
printf '%-16s %10s %8s %8s %8s\n' parser runs seconds branches inputs
for name in "${names[@]}"; do told "$name"; done
! grep -q FAILED "$kept/failed"
