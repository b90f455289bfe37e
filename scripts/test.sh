#!/usr/bin/env bash
# Every check of the project. The last lines are ctest's summary, and they decide.
#
#   bash scripts/test.sh           all builds: dev, sanitizers, fuzzing; tests labelled fast
#   bash scripts/test.sh --all     the tests labelled slow as well
#   bash scripts/test.sh --quick   the dev build only
#
# A check that fails before the end does not stop the others: the case `scripts.earlier_checks` of the
# last suite fails in its name.
set -euo pipefail
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

labels=(--label-regex '^fast$')
quick=false
slow=false
for argument in "$@"; do
  case $argument in
    --all)
      labels=(--label-regex '^(fast|slow)$')
      slow=true
      ;;
    --quick) quick=true ;;
    *)
      echo "usage: $0 [--all] [--quick]" >&2
      exit 2
      ;;
  esac
done

failed=()

heading() {
  printf '\n=== %s (%d min since the start) ===\n' "$1" $((SECONDS / 60))
}

# check NAME COMMAND...: runs it; a failure is kept for the end.
check() {
  local name=$1
  shift
  heading "$name"
  if "$@"; then
    echo "passed: $name"
  else
    echo "FAILED: $name"
    failed+=("$name")
  fi
}

# build PRESET [TARGET...]: configures and compiles it.
build() {
  configure "$1" && compile "$@"
}

sanitizer() {
  local log="build/log/$1-test.txt"
  build "$1" || return 1
  if ! ctest --preset "$1" --parallel "$jobs" --quiet --output-log "$log"; then
    tail -n 60 "$log"
    return 1
  fi
  grep 'tests passed' "$log"
}

fuzzing() {
  build fuzz fuzzers &&
    ctest --test-dir build/fuzz --parallel "$jobs" --label-regex '^fuzz$' --no-tests=error --output-on-failure
}

heading "packages"
if [[ $slow == true ]]; then
  bash scripts/install_packages.sh slow
else
  bash scripts/install_packages.sh test
fi

check "dev: build" build dev
if [[ $slow == true ]]; then
  check "dev: build of the slow trials" build dev slow_tests
fi
if [[ $quick == false ]]; then
  check "asan: AddressSanitizer and UndefinedBehaviorSanitizer" sanitizer asan
  check "tsan: ThreadSanitizer" sanitizer tsan
  check "fuzz: every parser of outside bytes, ten seconds each" fuzzing
fi

heading "dev: tests"
if ((${#failed[@]} > 0)); then
  echo "failed so far:"
  printf '  %s\n' "${failed[@]}"
fi
IMUNOISE_EARLIER_CHECKS="${failed[*]-}" \
  ctest --preset dev --parallel "$jobs" "${labels[@]}" --no-tests=error
