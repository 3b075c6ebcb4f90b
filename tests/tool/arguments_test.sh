#!/usr/bin/env bash
# Help, wrong arguments, missing inputs, and what may be overwritten.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "$0")/support.sh" "$@"

run 0 --help
for verb in encode decode info verify planes simulate bench; do says stdout "  $verb "; done
says stdout "Exit codes: 0 done, 1 failed, 2 wrong arguments, 3 finished with data loss"
for verb in encode decode info verify planes simulate; do
  run 0 "$verb" --help
  is_empty stderr
  matches_expected "help_$verb"
done
run 0 --version
says stdout "pointreel "

# 2: wrong arguments, naming the option.
wrong() {
  local named=$1
  shift
  run 2 "$@"
  is_empty stdout
  says stderr "$named"
}
wrong "subcommand"
wrong "--output" encode drive
wrong "--threshhold" encode drive -o a.reel --threshhold 1cm
wrong "--max-error: '1 inch' is not a length" encode drive -o a.reel --max-error "1 inch"
wrong "--max-error must lie in 0.0005 to 1 m" encode drive -o a.reel --max-error 2m
wrong "--group must lie in 1 to 255" encode drive -o a.reel --group 256
wrong "--fields: 'none,ring': none stands alone" encode drive -o a.reel --fields none,ring
wrong "--fields: 'ring:' is not" encode drive -o a.reel --fields ring:
wrong "--fields: 'ring:-1' is not" encode drive -o a.reel --fields all,ring:-1
wrong "--fields: '' is not" encode drive -o a.reel --fields ring,
wrong "--fields: 'ring' is named twice" encode drive -o a.reel --fields ring,ring:2
wrong "--method" encode drive -o a.reel --method zip
wrong "--threads" encode drive -o a.reel --threads -1

planes=(encode drive -o a.reel --method planes --grid uniform)
wrong "--threshold: '1 inch' is not a length" "${planes[@]}" --threshold "1 inch"
wrong "--threshold must lie in 0.001 to 10 m" "${planes[@]}" --threshold 20m
wrong "--group must lie in 1 to 255" "${planes[@]}" --group 0
wrong "--tile must lie in 2 to 16" "${planes[@]}" --tile 1
wrong "--azimuth-step: '1gon' is not an angle" "${planes[@]}" --azimuth-step 1gon
wrong "azimuth and elevation steps" "${planes[@]}" --azimuth-step 10deg
wrong "--residual-step" "${planes[@]}" --residual-step 0
wrong "--residual-step" "${planes[@]}" --residual-step never
wrong "--imu" "${planes[@]}" --imu a.csv --poses b.txt
wrong "--motion none goes without --poses and --imu" encode drive -o a.reel --motion none --poses a.txt
wrong "--motion" encode drive -o a.reel --motion maybe

# Options of the other grid, even with their default values.
wrong "--max-error does not go with --method planes --grid uniform; the uniform grid has --threshold" "${planes[@]}" --max-error 2cm
wrong "--fields does not go with --method planes --grid uniform" "${planes[@]}" --fields all
wrong "--no-temporal does not go with --method planes --grid uniform; for the uniform grid, use --group 1" "${planes[@]}" --no-temporal
wrong "--effort does not go with --method planes --grid uniform" "${planes[@]}" --effort max
wrong "--effort" encode drive -o a.reel --effort slow
wrong "--grid" "${planes[@]}" --grid square
wrong "--grid goes with --method planes only" encode drive -o a.reel --grid uniform
wrong "--threshold goes only with --method planes --grid uniform; all else has --max-error" encode drive -o a.reel --threshold 0.1
for option in --azimuth-step=1deg --elevation-step=1deg --tile=4 --residual-step=auto; do
  wrong "${option%=*} goes only with --method planes --grid uniform" encode drive -o a.reel "$option"
  wrong "${option%=*} goes only with --method planes --grid uniform" encode drive -o a.reel --method planes "$option"
done
[[ ! -e a.reel ]] || fail "an output of wrong arguments"

wrong "--idle goes with --follow only" encode drive -o a.reel --idle 1
wrong "--follow takes one folder" encode --follow drive other -o a.reel
wrong "--follow takes one folder" encode --follow - -o a.reel
wrong "- for standard input goes with no other" encode - drive -o a.reel
wrong "--poses and --imu go with files" "${planes[@]/drive/-}" --poses a.txt
wrong "--json and -o -" encode drive -o - --json
wrong "--frames: '3:1' is not A:B" decode a.reel -o out --frames 3:1
wrong "--frames: 'x' is not A:B" decode a.reel -o out --frames x
wrong "--frames: '3:1' is not A:B" planes a.reel -o out.json --frames 3:1
wrong "-o: out.txt ends neither in .json nor in .ply" planes a.reel -o out.txt
wrong "docx" decode a.reel -o out --format docx
wrong "--sensor: " simulate -o drive --sensor hdl-1
wrong "--frames" simulate -o drive --frames 0
wrong "INPUT" verify a.reel
wrong "REEL: one at a time" info a.reel b.reel

# 1: what is named is not there or no reel.
failed() {
  local named=$1
  shift
  run 1 "$@"
  says stderr "$named"
}
echo "no reel at all, just some text that is longer than the header of one" >notes.txt
failed "missing_folder" encode missing_folder -o a.reel
[[ ! -e a.reel ]] || fail "an output without an input"
failed "missing.reel: cannot open" info missing.reel
failed "missing.reel: cannot open" decode missing.reel -o out
failed "notes.txt: not a .reel stream" info notes.txt
failed "notes.tx?x" verify missing.reel "notes.tx?x"
mkdir empty
failed "empty" encode empty -o a.reel

# Outputs are overwritten with -f only.
make_planes_drive
cp drive.reel before.reel
failed "drive.reel: exists; -f overwrites it" encode drive -o drive.reel
same_file drive.reel before.reel
run 0 encode drive -o drive.reel -f
cmp -s drive.reel before.reel && fail "-f did not overwrite"
failed "velodyne: is not empty; -f overwrites" simulate -o drive --frames 1 --sensor vlp-16
run 0 simulate -o drive --frames 1 --sensor vlp-16 -f
failed "cannot open for writing" encode drive -o no/such/folder/a.reel

# An output that exists survives when there is nothing to put in its place, and is never an input.
run 0 simulate -o survivors --frames 1 --sensor vlp-16
sweep=survivors/velodyne/0000000000.bin
run 0 encode "$sweep" -o kept.reel
cp kept.reel kept.copy
head -c 15 "$sweep" >cut.bin
failed "cut.bin" encode cut.bin -o kept.reel -f
same_file kept.reel kept.copy
cp "$sweep" sweep.copy
failed "--fields: $sweep has no field ring (it has intensity)" encode "$sweep" -o kept.reel -f --fields all,ring:1
same_file kept.reel kept.copy
failed "has no field ring" encode "$sweep" -o new.reel --fields ring
[[ ! -e new.reel ]] || fail "an output although a field is missing"
failed "is one of the inputs" encode "$sweep" -o "$sweep" -f
same_file "$sweep" sweep.copy
