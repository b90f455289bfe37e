#!/usr/bin/env bash
# Our processor time and memory beside those of the R packages for the same work. Their figures were measured
# once, on one machine, and stand in the table below; ours are measured now. A benchmark that is not there
# leaves its line empty.
set -euo pipefail
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/../scripts/common.sh"

out=build/bench
mkdir -p "$out"
bash scripts/install_packages.sh bench
echo "Building bench_imunoise ..."
configure release
compile release bench_imunoise
program=$(find build/release -type f -name bench_imunoise -perm -u+x | head -n 1)

# cpu_seconds NAME: mean processor time of all threads in the benchmark named so, in seconds; empty when absent.
cpu_seconds() {
  awk -F, -v name="$1" '
    BEGIN { factor["ns"] = 1e-9; factor["us"] = 1e-6; factor["ms"] = 1e-3; factor["s"] = 1 }
    { gsub(/"/, "", $1) }
    $1 == name || index($1, name "/") == 1 { printf "%.4g", $4 * factor[$5]; exit }' "$out/all.csv"
}

# mebibytes FILTER: peak memory of the program running only that benchmark, once; empty when absent.
mebibytes() {
  if "$program" --benchmark_filter="$1" --benchmark_list_tests 2> /dev/null | grep -q .; then
    /usr/bin/time --format '%M' --output "$out/peak.txt" \
      "$program" --benchmark_filter="$1" --benchmark_min_time=0 > /dev/null 2>&1
    awk '{ printf "%.0f", $1 / 1024 }' "$out/peak.txt"
  fi
}

echo "Measuring ..."
quietly build/log/bench.txt "$program" --benchmark_out="$out/all.csv" --benchmark_out_format=csv
# The header of the table starts with "name".
sed -i -n '/^name,/,$p' "$out/all.csv"

# row WORK PEER THEIR_SECONDS THEIR_MIB OUR_SECONDS OUR_MIB
row() {
  local ratio=""
  if [[ -n $5 ]]; then
    ratio=$(awk -v theirs="$3" -v ours="$5" 'BEGIN { printf "%.0f", theirs / ours }')
  fi
  printf '%-44s %-8s %10s %8s %10s %8s %8s\n' \
    "$1" "$2" "$3" "${4:--}" "${5:--}" "${6:--}" "${ratio:--}"
}

echo
printf '%-44s %-8s %10s %8s %10s %8s %8s\n' "" "peer" "theirs" "" "ours" "" "times"
printf '%-44s %-8s %10s %8s %10s %8s %8s\n' "work" "" "CPU s" "MiB" "CPU s" "MiB" "faster"
wavelet='classical<double>/samples:10000000/per_octave:1/threads:1'
row "wavelet variance, 1e7 doubles" "R wv" 9.08 2035 "$(cpu_seconds "$wavelet")" "$(mebibytes "$wavelet")"
wavelet='classical<std::int16_t>/samples:10000000/per_octave:1/threads:1'
row "  the same from 16-bit counts" "R wv" 9.08 2035 "$(cpu_seconds "$wavelet")" "$(mebibytes "$wavelet")"
wavelet='classical<double>/samples:1000000/per_octave:1/threads:1'
row "wavelet variance, 1e6 doubles" "R wv" 0.55 "" "$(cpu_seconds "$wavelet")" "$(mebibytes "$wavelet")"
row "fit AR1+WN+RW to 6 x 1e6 samples" "mgmwm" 17.9 "" "$(cpu_seconds 'mugmwm/AR1+WN+RW')" ""
row "fit 3*AR1+WN to 6 x 1e6 samples" "mgmwm" 29.4 "" "$(cpu_seconds 'mugmwm/3*AR1+WN')" ""

echo
echo "All benchmarks (processor time of all threads):"
awk -F, 'NR > 1 { gsub(/"/, "", $1); printf "  %-72s %12.4g %s\n", $1, $4, $5 }' "$out/all.csv"
echo "Memory is the peak of the whole process, samples included."
