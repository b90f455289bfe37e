#!/usr/bin/env bash
# Runs every command `imunoise ...` of a guide, in order, in an empty folder: run_guide.sh PROGRAM GUIDE.md
# A file PREPARE_GUIDE.py beside this script makes what the guide's reader has. Exit status 77: it cannot run here.
set -euo pipefail
program=$(realpath "$1")
guide=$(realpath "$2")
here=$(realpath "$(dirname "$0")")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
mkdir bin
ln -s "$program" bin/imunoise
export PATH=$folder/bin:$PATH
prepare=$here/prepare_$(basename "$guide" .md | tr - _).py
if [[ -e $prepare ]]; then
  /usr/bin/python3 "$prepare" || exit $?
fi
# Commands are indented by four spaces or more and begin with the program's name.
grep -E '^ {4,}imunoise ' "$guide" | sed -E 's/^ +//' > commands || { echo "$guide: no commands" >&2; exit 1; }
while IFS= read -r command; do
  echo "\$ $command"
  bash -c "$command" < /dev/null
done < commands
