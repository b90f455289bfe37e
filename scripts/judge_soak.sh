#!/usr/bin/env bash
# What a soak (soak.sh) left behind: are the recordings sound, is every row accounted for, was anything lost but
# what faults took, what did a kill cost, is memory flat? Draws memory over time.
#
#   bash scripts/judge_soak.sh IMUNOISE FOLDER SPEED
set -euo pipefail
imunoise=$1
out=$2
speed=$3
here=$(dirname "${BASH_SOURCE[0]}")

touch "$out/kills.txt"
bad=0
: > "$out/streams.tsv"
: > "$out/replicates.tsv"
for recording in "$out"/recordings/*/; do
  # What a last kill left in a journal is put in its place, as the next start would have done.
  "$imunoise" verify "$recording" --repair > "$out/repair.txt" || bad=1
  # One line a stream: replicate device stream received stored refused lost gaps duplicates in_journal rate
  "$imunoise" verify "$recording" --json > "$out/verify.json" || bad=1
  jq -r '.streams[] | [.replicate, .device, .stream, .received, .stored, ([.refused[].samples | tonumber] | add // 0),
      .lost, .gap_count, .duplicates, .in_journal, .nominal_rate_hz] | @tsv' "$out/verify.json" >> "$out/streams.tsv"
  jq -r '.defects[]?' "$out/verify.json"
  jq -r --slurp 'sort_by(.note.replicate)[].note | [.replicate, .state, .started_ns, .ended_ns] | @tsv' \
    "$recording"/replicate-*.json >> "$out/replicates.tsv"
done
injected=$(grep -m 1 'options.fault' "$out/soak.toml" | grep -o 'sample=' | wc -l)

awk -v speed="$speed" -v injected="$injected" -v bad="$bad" -f "$here/judge_soak.awk" \
  "$out/replicates.tsv" "$out/streams.tsv" "$out/kills.txt" "$out/memory.txt" || bad=1
awk -v speed="$speed" -f "$here/plot_memory.awk" "$out/kills.txt" "$out/memory.txt" > "$out/memory.svg"
echo "memory over time: $out/memory.svg"
exit "$bad"
