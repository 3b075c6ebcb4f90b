#!/usr/bin/env bash
# Installs a build to a temporary prefix, then builds the project in this folder against it twice, by CMake and by
# pkg-config, and runs both programs.
set -euo pipefail

if (($# != 1)); then
  echo "usage: install_test.sh BUILD_FOLDER" >&2
  exit 2
fi
build=$(realpath "$1")
here=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
compiler=$(sed -n 's/^CMAKE_CXX_COMPILER:[A-Z]*=//p' "$build/CMakeCache.txt")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

cmake --install "$build" --prefix "$scratch/prefix" >"$scratch/install.log"
export PKG_CONFIG_PATH
PKG_CONFIG_PATH=$(dirname "$(find "$scratch/prefix" -name pointreel.pc)")

cmake -S "$here" -B "$scratch/by_cmake" -DCMAKE_PREFIX_PATH="$scratch/prefix" \
  -DCMAKE_CXX_COMPILER="$compiler" >"$scratch/configure.log"
cmake --build "$scratch/by_cmake"

read -ra flags < <(pkg-config --cflags --libs --static pointreel)
"$compiler" -std=c++20 "$here/main.cpp" "${flags[@]}" -o "$scratch/by_pkg_config"

# Three points of four float32.
head -c 48 /dev/zero >"$scratch/sweep.bin"
for program in "$scratch/by_cmake/point_count" "$scratch/by_pkg_config"; do
  points=$("$program" "$scratch/sweep.bin")
  if [[ $points != 3 ]]; then
    echo "$program counts $points points, not 3" >&2
    exit 1
  fi
done
echo "the installed library works by CMake and by pkg-config"
