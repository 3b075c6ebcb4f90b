# Sourced by the tests of the tool: `source support.sh "$@"`, with the tool's path as first argument. Works in
# a folder of its own, which is removed at the end.
# shellcheck shell=bash
set -euo pipefail

pointreel=$(realpath "$1")
tests=$(dirname "$(realpath "${BASH_SOURCE[0]}")")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

fail() {
  echo "FAILED: $*" >&2
  echo "--- stdout" >&2 && cat stdout >&2
  echo "--- stderr" >&2 && cat stderr >&2
  exit 1
}

# run CODE ARGUMENTS...: the tool must exit with CODE; its output is left in stdout and stderr.
run() {
  local expected=$1 code=0
  shift
  "$pointreel" "$@" >stdout 2>stderr || code=$?
  if ((code != expected)); then fail "exit code $code instead of $expected: pointreel $*"; fi
}

# says FILE TEXT: the text is in stdout or stderr.
says() {
  grep -qF -e "$2" "$1" || fail "no '$2' in $1"
}

is_empty() {
  [[ ! -s $1 ]] || fail "$1 is not empty"
}

same_file() {
  cmp -s "$1" "$2" || fail "$1 and $2 differ"
}

# json EXPRESSION: stdout is JSON and nothing else, and the Python expression over `r` holds.
json() {
  python3 - "$1" <<'PYTHON' || fail "JSON: $1"
import json, sys
r = json.load(open("stdout"))
sys.exit(not eval(sys.argv[1]))
PYTHON
}

# matches_expected NAME: stdout is tests/tool/expected/NAME.txt, once figures, which may vary, are replaced by #.
# UPDATE_EXPECTED=1 writes the file instead, to be looked at before it is committed.
matches_expected() {
  sed -E "s|$pointreel|pointreel|; s/[0-9]+(\.[0-9]+)?/#/g; s/ +/ /g; s/# [kM]?B\b/# B/g" stdout >normalised
  if [[ -n ${UPDATE_EXPECTED:-} ]]; then cp normalised "$tests/expected/$1.txt"; fi
  diff -u "$tests/expected/$1.txt" normalised >&2 || fail "not as in expected/$1.txt"
}

# A drive of five sweeps, compressed by method planes in two groups.
make_planes_drive() {
  run 0 simulate -o drive --frames 5 --sensor vlp-16
  run 0 encode drive -o drive.reel --method planes --grid uniform --elevation-step 2deg --group 3
}
