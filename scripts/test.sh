#!/usr/bin/env bash
# Checks the project. Says what runs, how far it is and what has failed; ends with the slowest stages and cases and
# with ctest's summary of the fast tests.
#
#   bash scripts/test.sh           build, and the tests labelled fast
#   bash scripts/test.sh --full    the same under AddressSanitizer, UndefinedBehaviorSanitizer and ThreadSanitizer too,
#                                  and every parser fuzzed for ten seconds
#   bash scripts/test.sh --all     the tests labelled slow as well: hours
#
# Exit status 1 when a stage failed; the other stages run all the same. Logs: build/log/.
set -euo pipefail
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

full=false
slow=false
for argument in "$@"; do
  case $argument in
    --full) full=true ;;
    --all) full=true slow=true ;;
    *)
      echo "usage: $0 [--full | --all]" >&2
      exit 2
      ;;
  esac
done

failed=()
times=() # of stages: "SECONDS NAME"

# stage NAME COMMAND...: runs it; a failure is kept for the end.
stage() {
  local name=$1 begin=$SECONDS outcome=passed
  shift
  printf '\n=== %s (%s since the start%s) ===\n' "$name" "$(clock "$SECONDS")" \
    "${failed:+; failed so far: ${failed[*]}}"
  if ! "$@"; then
    outcome=FAILED
    failed+=("[$name]")
  fi
  times+=("$((SECONDS - begin)) $name")
  printf '%s: %s in %s\n' "$outcome" "$name" "$(clock $((SECONDS - begin)))"
}

# build PRESET [TARGET...]: configures and compiles it.
build() {
  configure "$1" && compile "$@"
}

# suite PRESET LABELS: runs the tests so labelled. Most of them wait, for devices, clocks and time-outs, so there are
# more of them at a time than processors.
suite() {
  rm -rf "build/$1/cases"
  ctest --preset "$1" --parallel $((2 * jobs)) --label-regex "$2" --no-tests=error 2>&1 |
    tee "build/log/$1-test.txt"
}

fuzzing() {
  ctest --preset asan --parallel "$jobs" --label-regex '^fuzz$' --no-tests=error 2>&1 | tee build/log/fuzz-test.txt
}

# cases PRESET: what awk reads of the last suite's reports.
cases() {
  find "build/$1/cases" -name '*.xml' -exec awk -f scripts/cases.awk {} + 2> /dev/null || true
}

# tell_cases PRESET: how many cases ran, and which were skipped for what reason.
tell_cases() {
  local list="build/log/$1-cases.tsv"
  cases "$1" > "$list"
  awk -F '\t' -v preset="$1" '{++n[$2]}
    END {printf "%s: %d cases passed, %d failed, %d skipped\n", preset, n["passed"], n["failed"], n["skipped"]}' "$list"
  awk -F '\t' '$2 == "skipped" {printf "  skipped: %s: %s\n", $3, $4}' "$list"
}

# slowest COUNT: the lines "SECONDS NAME" that take longest.
slowest() {
  sort -rn | awk -v count="$1" 'NR <= count {seconds = $1; $1 = ""; printf "  %7.1f s %s\n", seconds, $0}'
}

presets=(dev)
packages=test
labels='^fast$'
room=4
if [[ $full == true ]]; then
  presets=(dev asan tsan)
  room=12
fi
if [[ $slow == true ]]; then
  packages=slow
  labels='^(fast|slow)$'
fi

need_room "$room"
bash scripts/install_packages.sh "$packages"
mkdir -p build/log

stage "dev: build" build dev
if [[ $slow == true ]]; then
  stage "dev: build of the slow trials" build dev slow_tests
fi
stage "dev: tests" suite dev "$labels"
if [[ $full == true ]]; then
  stage "AddressSanitizer, UndefinedBehaviorSanitizer and fuzzers: build" build asan
  stage "AddressSanitizer and UndefinedBehaviorSanitizer: tests" suite asan '^fast$'
  stage "fuzzing: every parser of outside bytes, ten seconds each" fuzzing
  stage "ThreadSanitizer: build" build tsan
  stage "ThreadSanitizer: tests" suite tsan '^fast$'
fi

printf '\n=== all stages done after %s ===\n' "$(clock "$SECONDS")"
for preset in "${presets[@]}"; do tell_cases "$preset"; done
echo "slowest cases:"
for preset in "${presets[@]}"; do awk -F '\t' -v preset="$preset" '{print $1, preset ": " $3}' "build/log/$preset-cases.tsv"; done |
  slowest 10
echo "slowest stages:"
printf '%s\n' "${times[@]}" | slowest 10
if ((${#failed[@]} > 0)); then
  echo
  printf 'FAILED: %s\n' "${failed[@]}"
fi
echo
echo "ctest of the dev build:"
sed -n '/tests passed/,$p' build/log/dev-test.txt
((${#failed[@]} == 0))
