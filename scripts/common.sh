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

# configure PRESET [ARGUMENT...]: from nothing it joins sources (CMake's unity build), which takes half the time; a
# folder that somebody builds in stays as it is.
configure() {
  local preset=$1
  shift
  local joined=()
  if [[ ! -f build/$preset/CMakeCache.txt ]]; then
    joined=(-DCMAKE_UNITY_BUILD=ON)
  fi
  quietly "build/log/$preset-configure.txt" cmake --preset "$preset" "${joined[@]}" "$@"
}

# compile PRESET [TARGET...]: all of it where no target is named.
compile() {
  local preset=$1
  shift
  quietly "build/log/$preset-build.txt" cmake --build --preset "$preset" --parallel "$jobs" --target "${@:-all}"
}
