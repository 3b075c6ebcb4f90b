#!/usr/bin/env bash
# Decodes the golden streams with one build of the decoder and compares the digests of all positions and fields. The builds
# (tests/CMakeLists.txt runs each) are by several compilers, at several optimisation levels, for x86-64 and (under qemu)
# aarch64, by SIMD and without. Exit code 77: skipped, as a compiler or qemu is not installed.
set -euo pipefail

if (($# != 4)); then
  echo "usage: decode_paths_test.sh SOURCE_FOLDER LIST_OF_THE_LIBRARY'S_OBJECTS SCRATCH_FOLDER BUILD" >&2
  exit 2
fi
root=$(realpath "$1")
library_objects=$(realpath "$2")
mkdir -p "$3"
scratch=$(realpath "$3")
build=$4

# check [RUNNER] PROGRAM: the golden digests.
check() {
  local reel
  for reel in "$root"/tests/golden/*.reel; do
    "$@" "$reel" | diff "${reel%.reel}.txt" - || {
      echo "$build: $reel decodes to something else" >&2
      exit 1
    }
  done
  echo "$build: the golden digests, after $SECONDS s"
}

# Links with the library of this build, and leaves in decoding.txt what decoding needs of it: the sources of the objects that
# the linker takes.
as_built() {
  rm -f "$scratch/library.a"
  xargs ar rcT "$scratch/library.a" <"$library_objects"
  g++ -std=c++20 -I"$root/include" -I"$root/src" -I"$root/tests" -isystem /usr/include/eigen3 \
    "$root/tests/determinism/decode_digest.cpp" "$scratch/library.a" -lxxhash -lhwy -pthread -Wl,--trace \
    -o "$scratch/decode_digest" |
    sed -nE 's|.*pointreel\.dir/(\./)?(src/.*\.cpp)\.o$|\2|p' | sort -u >"$scratch/decoding.txt"
  check "$scratch/decode_digest"
}

flags=(-std=c++20 -ffp-contract=off -fno-math-errno -fno-trapping-math -DXXH_INLINE_ALL -pthread
  -I"$root" -I"$root/include" -I"$root/src" -I"$root/tests" -isystem /usr/include/eigen3)
# The system's headers come last, for Highway and xxHash: a cross compiler has a C library of its own.
flags+=(-idirafter /usr/include)

# compile OBJECT "COMPILER [OPTION]..." SOURCE...: all sources at once, which takes half the time; where two of them use a name
# for different things, one by one.
compile() {
  local object=$1 command source number=0
  read -ra command <<<"$2"
  if command -v ccache >/dev/null; then command=(ccache "${command[@]}"); fi
  shift 2
  printf '#include "%s"\n' "$@" >"$object.cpp"
  if "${command[@]}" "${flags[@]}" -c "$object.cpp" -o "$object.o" 2>"$object.log"; then return; fi
  echo "$build: $object's files do not compile together, see $PWD/$object.log"
  for source in "$@"; do
    "${command[@]}" "${flags[@]}" -c "$root/$source" -o "$object-$((++number)).o"
  done
}

# built_by "COMPILER [OPTION]..." LIBRARIES [RUNNER]: compiles what decoding.txt lists.
built_by() {
  local command runner=("${@:3}") program predict others
  read -ra command <<<"$1"
  for program in "${command[0]}" "${runner[@]}"; do
    if ! command -v "$program" >/dev/null; then
      echo "$build: skipped, there is no $program"
      exit 77
    fi
  done
  mkdir -p "$scratch/$build"
  cd "$scratch/$build"
  rm -f ./*.o
  # What is compiled once per instruction set stays by itself.
  local sources source predict=() others=()
  mapfile -t sources <"$scratch/decoding.txt"
  for source in "${sources[@]}"; do
    if grep -q hwy/foreach_target.h "$root/$source"; then
      compile "$(basename "$source" .cpp)" "$1" "$source"
    elif [[ $source == src/predict/* ]]; then
      predict+=("$source")
    else
      others+=("$source")
    fi
  done
  compile predict "$1" "${predict[@]}"
  compile others "$1" "${others[@]}" tests/determinism/decode_digest.cpp
  # shellcheck disable=SC2086 # no library is no argument
  "${command[@]}" "${flags[@]}" ./*.o $2 -o decode_digest
  check "${runner[@]}" ./decode_digest
}

case $build in
  as_built) as_built ;;
  gcc_O0_scalar) built_by "g++ -O0 -DHWY_COMPILE_ONLY_SCALAR -DPOINTREEL_SIMD_LOOPS=" "" ;;
  clang_O3) built_by "clang++ -O3" -lhwy ;;
  # (-O0 as well agrees, but takes a minute to run under qemu; -O3 takes 20 s longer to compile.)
  aarch64_O2) built_by "aarch64-linux-gnu-g++ -O2 -DHWY_COMPILE_ONLY_STATIC -static" "" qemu-aarch64 ;;
  *) echo "decode_paths_test.sh: there is no build '$build'" >&2 && exit 2 ;;
esac
