#!/usr/bin/env bash
# Compares the sizes of the fixed corpus with sizes.csv: a commit that changes them changes the file, too
# (cmake --build build/release --target pin_sizes).
set -euo pipefail
if (($# != 3)) || [[ $3 != check && $3 != pin ]]; then
  echo "usage: sizes_test.sh SIZES_PROGRAM SIZES.CSV check|pin" >&2
  exit 2
fi
if [[ $3 == pin ]]; then
  "$1" >"$2"
elif ! "$1" | diff --unified=0 "$2" -; then
  echo "sizes have changed (-: pinned, +: now); if that is meant: cmake --build build/release --target pin_sizes" >&2
  exit 1
fi
