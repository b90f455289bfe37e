# shellcheck shell=bash
# What the scripts share; sourced. Leaves the caller in the project's root.
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit

jobs=$(nproc)

# quietly LOG COMMAND...: runs the command, its output in LOG; shows the end of it when it fails.
quietly() {
  local log=$1
  shift
  mkdir -p "$(dirname "$log")"
  if ! "$@" > "$log" 2>&1; then
    echo "failed: $*" >&2
    echo "the end of $log:" >&2
    tail -n 40 "$log" >&2
    return 1
  fi
}
