#!/usr/bin/env bash
# usage: old_compiler_test.sh SOURCE_FOLDER COMPILER
# The compiler says that it is GCC 11: CMake refuses it, and says which one to use.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
printf '#!/bin/sh\nexec %s -U__GNUC__ -D__GNUC__=11 "$@"\n' "$2" > "$folder/g++"
chmod +x "$folder/g++"
if said=$(cmake -S "$1" -B "$folder/build" -DCMAKE_CXX_COMPILER="$folder/g++" 2>&1); then
  echo "GCC 11 was accepted: $said"
  exit 1
fi
said=$(echo "$said" | tr -s ' \n' ' ')
for words in 'GNU 11.' 'use GCC 12, Clang 14 or later, for example CXX=g++-12'; do
  case $said in
    *"$words"*) ;;
    *) echo "CMake does not say '$words': $said"; exit 1 ;;
  esac
done
