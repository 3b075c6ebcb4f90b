#!/usr/bin/env bash
# Decodes the golden streams with builds of the decoder by several compilers, at several optimisation levels, for x86-64
# and (under qemu) aarch64, by SIMD and without, and compares the digests of all positions and fields. What is not
# installed is skipped and named.
set -euo pipefail

if (($# != 3)); then
  echo "usage: decode_paths_test.sh SOURCE_FOLDER LIST_OF_THE_LIBRARY'S_OBJECTS SCRATCH_FOLDER" >&2
  exit 2
fi
root=$(realpath "$1")
library_objects=$(realpath "$2")
mkdir -p "$3"
scratch=$(realpath "$3")

# What decoding needs of the library: the objects of this build that the linker takes, as their sources.
sources_of_decoding() {
  rm -f "$scratch/library.a"
  xargs ar rcT "$scratch/library.a" <"$library_objects"
  g++ -std=c++20 -I"$root/include" -I"$root/src" -I"$root/tests" -isystem /usr/include/eigen3 \
    "$root/tests/determinism/decode_digest.cpp" "$scratch/library.a" -lxxhash -lhwy -pthread -Wl,--trace \
    -o "$scratch/decode_digest" |
    sed -nE 's|.*pointreel\.dir/(\./)?(src/.*\.cpp)\.o$|\2|p' | sort -u
}
sources=$(sources_of_decoding)
sources=tests/determinism/decode_digest.cpp\ ${sources//$'\n'/ }

# check NAME "COMPILER [OPTION]..." LIBRARIES [RUNNER]
check() {
  local name=$1 libraries=$3 started=$SECONDS
  local command runner=()
  read -ra command <<<"$2"
  if [[ -n ${4:-} ]]; then runner=("$4"); fi
  local program
  for program in "${command[0]}" "${runner[@]}"; do
    if ! command -v "$program" >/dev/null; then
      echo "$name: skipped, there is no $program"
      return
    fi
  done
  mkdir -p "$scratch/$name"
  make --silent -j2 -C "$scratch/$name" -f "$root/tests/determinism/decoder.mk" ROOT="$root" SOURCES="$sources" \
    CXX="${command[0]}" OPTIONS="${command[*]:1}" LIBRARIES="$libraries" >&2
  local reel
  for reel in "$root"/tests/golden/*.reel; do
    "${runner[@]}" "$scratch/$name/decode_digest" "$reel" | diff "${reel%.reel}.txt" - || {
      echo "$name: $reel decodes to something else" >&2
      exit 1
    }
  done
  echo "$name: the golden digests, after $((SECONDS - started)) s"
}

check gcc_O0_scalar "g++ -O0 -DHWY_COMPILE_ONLY_SCALAR" ""
check gcc_O3 "g++ -O3" -lhwy
check clang_O0 "clang++ -O0 -DHWY_COMPILE_ONLY_EMU128" ""
check clang_O3 "clang++ -O3" -lhwy
# (-O0 as well agrees, but takes a minute to run under qemu.)
check aarch64_O3 "aarch64-linux-gnu-g++ -O3 -DHWY_COMPILE_ONLY_STATIC -static" "" qemu-aarch64
