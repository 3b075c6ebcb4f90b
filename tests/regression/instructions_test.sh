#!/usr/bin/env bash
# Counts the instructions that the parts of encoding and decoding take on three fixed simulated sweeps (callgrind, one thread,
# millions) and compares them with instructions.csv, within 3 per cent: a commit that changes them changes the file, too
# (cmake --build build/release --target pin_instructions). Counts are those of g++ 12 on x86-64 with AVX2. Exit code 77: skipped,
# as there is no valgrind, or this is another machine or build.
set -euo pipefail
if (($# != 4)) || [[ $4 != check && $4 != pin ]]; then
  echo "usage: instructions_test.sh POINTREEL INSTRUCTIONS.CSV COMPILER_VERSION check|pin" >&2
  exit 2
fi
pointreel=$1
pinned=$2
if ! command -v callgrind_annotate >/dev/null; then
  echo "skipped: valgrind is not installed"
  exit 77
fi
if [[ $3 != 12.* || $(uname -m) != x86_64 ]] || ! grep -q ' avx2 ' /proc/cpuinfo; then
  echo "skipped: counts are pinned for g++ 12 on x86-64 with AVX2, not for compiler $3 here"
  exit 77
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# profile NAME ARGUMENTS...: runs pointreel, leaving inclusive counts by function.
profile() {
  local name=$1
  valgrind --tool=callgrind --callgrind-out-file="$folder/$name.out" "$pointreel" "${@:2}" >/dev/null 2>"$folder/$name.log" || {
    cat "$folder/$name.log" >&2
    exit 1
  }
  callgrind_annotate --inclusive=yes --threshold=100 "$folder/$name.out" >"$folder/$name.txt"
}
# part PROFILE FUNCTION: millions of instructions within the function and what it calls.
part() {
  awk -v function_name="pointreel::$2(" '
    index($0, function_name) { gsub(",", "", $1); if ($1 + 0 > most) most = $1 + 0 }
    END { printf "%.1f", most / 1e6 }' "$folder/$1.txt"
}

"$pointreel" simulate -o "$folder/drive" --frames 3 --sensor hdl-64e >/dev/null
profile encode encode "$folder/drive" -o "$folder/drive.reel" --fields none --threads 1
profile decode decode "$folder/drive.reel" -o "$folder/decoded" --threads 1
{
  echo "verb,part,million_instructions"
  for name in project SweepAlignment::follow warp encode_band encode_cells encode_points; do
    echo "encode,$name,$(part encode "$name")"
  done
  for name in warp decode_band decode_cells decode_points; do
    echo "decode,$name,$(part decode "$name")"
  done
} >"$folder/now.csv"
if [[ $4 == pin ]]; then
  cp "$folder/now.csv" "$pinned"
  exit 0
fi
paste -d, "$pinned" "$folder/now.csv" | awk -F, '
  NR == 1 { next }
  $1 != $4 || $2 != $5 { print "the parts differ: " $0; bad = 1; next }
  { change = $3 > 0 ? 100 * ($6 / $3 - 1) : 0
    printf "%-8s %-24s %8.1f M, pinned %8.1f M: %+.1f %%\n", $4, $5, $6, $3, change
    if ($6 == 0 || change > 3 || change < -3) bad = 1 }
  END { exit bad }' || {
  echo "instruction counts have changed; if that is meant: cmake --build build/release --target pin_instructions" >&2
  exit 1
}
