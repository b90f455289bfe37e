# shellcheck shell=bash
# What the scripts share; sourced. Leaves the caller in the project's root.
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit

jobs=$(nproc)

# clock SECONDS: "48 s", "12 min 5 s".
clock() {
  if (($1 < 60)); then echo "$1 s"; else echo "$(($1 / 60)) min $(($1 % 60)) s"; fi
}

# progress_of LOG: how far a build has come, by the last line of ninja in its log: "213 of 460".
progress_of() {
  tail -c 2000 "$1" | grep -oE '^\[[0-9]+/[0-9]+\]' | tail -n 1 | sed -E 's/\[(.*)\/(.*)\]/\1 of \2/' || true
}

# remedy_of LOG: one line for what a log shows to have gone wrong, where there is a known remedy.
remedy_of() {
  if grep -q 'No space left on device' "$1"; then
    echo "the disk is full ($(df -h --output=avail . | tail -n 1 | tr -d ' ') free here): make room, or delete build/"
  elif grep -qE 'Killed signal terminated program|out of memory' "$1"; then
    echo "the compiler ran out of memory: close other programs, or build with fewer jobs (nproc says $jobs)"
  elif grep -qE 'Could NOT find|Could not find a package|Package .* not found' "$1"; then
    echo "a library is missing: bash scripts/install_packages.sh test"
  fi
}

# quietly LOG COMMAND...: runs the command, its output in LOG. Says every half minute (on a terminal: every
# second) how far it is; shows the end of the log, and the remedy, when it fails.
quietly() {
  local log=$1 begin=$SECONDS pause=30 child status=0
  shift
  mkdir -p "$(dirname "$log")"
  if [[ -t 1 ]]; then pause=1; fi
  local next=$pause
  "$@" > "$log" 2>&1 &
  child=$!
  trap 'kill "$child" 2> /dev/null; exit 130' INT TERM
  while kill -0 "$child" 2> /dev/null; do
    sleep 0.2
    if ((SECONDS - begin >= next)); then
      next=$((SECONDS - begin + pause))
      if [[ -t 1 ]]; then printf '\r\033[K'; fi
      printf '    %s after %s' "$(progress_of "$log")" "$(clock $((SECONDS - begin)))"
      if [[ ! -t 1 ]]; then echo; fi
    fi
  done
  if [[ -t 1 ]]; then printf '\r\033[K'; fi
  wait "$child" || status=$?
  trap - INT TERM
  if ((status != 0)); then
    echo "failed: $*" >&2
    echo "the end of $log:" >&2
    tail -n 40 "$log" >&2
    local remedy
    remedy=$(remedy_of "$log")
    if [[ -n $remedy ]]; then echo "what to do: $remedy" >&2; fi
  fi
  return "$status"
}

# need_room GIGABYTES: fails with the remedy where the disk has less room than a build takes.
need_room() {
  local free
  free=$(df --output=avail --block-size=1G . | tail -n 1)
  if ((free >= $1)); then return 0; fi
  echo "the disk has ${free} GB free, and the builds take $1 GB: make room, or work on another disk" >&2
  return 1
}

# configure PRESET [ARGUMENT...]: from nothing it joins sources (CMake's unity build), which takes half the time; a
# folder that you build in yourself stays as it is.
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
