#!/usr/bin/env bash
# - for standard input and output: the bytes are those of files, and reports go to the other stream.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "$0")/support.sh" "$@"
make_planes_drive
options=(--method planes --grid uniform --elevation-step 2deg --group 3)
run 0 decode drive.reel -o files

"$pointreel" encode drive -o - "${options[@]}" 2>stderr >stdout
same_file stdout drive.reel
says stderr "5 sweeps"

"$pointreel" encode drive -o - "${options[@]}" 2>stderr | "$pointreel" decode - -o piped >stdout
for file in files/*; do same_file "$file" "piped/${file#*/}"; done

run 0 info - <drive.reel
says stdout "5 sweeps (2 key frames)"
run 0 verify - drive --json <drive.reel
json "r['bound_held'] is True"
run 0 decode - -o range --frames 1:3 <drive.reel
[[ $(cd range && echo *) == "000001.bin 000002.bin" ]] || fail "--frames from a pipe"
head -c 5000 drive.reel | "$pointreel" info - >stdout 2>stderr && fail "a cut pipe went unnoticed"
says stderr "standard input: packet at byte"
run 1 info - </dev/null
says stderr "standard input: stream ends within its header"
