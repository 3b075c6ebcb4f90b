#!/usr/bin/env bash
# Sweeps encoded as they arrive, from a watched folder or through a pipe, and decoded as their packets arrive.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "$0")/support.sh" "$@"
run 0 simulate -o drive --frames 5 --sensor vlp-16
run 0 encode drive -o drive.reel
run 0 decode drive.reel -o from_file
run 0 decode drive.reel -o pcd --format pcd
run 0 decode drive.reel -o ply --format ply

# wait_for FILE: at most ten seconds.
wait_for() {
  local tries
  for ((tries = 0; tries < 1000; ++tries)); do
    if [[ -e $1 ]]; then return; fi
    sleep 0.01
  done
  fail "$1 did not come"
}

# A folder, while sweeps are put into it: the first ones are decoded at the far end before the last one is there.
mkdir live
mkfifo packets
"$pointreel" encode --follow live -o - --idle 60 >packets 2>stderr_encode &
encoder=$!
tee piped.reel <packets | "$pointreel" decode - -o live_out >stdout_decode 2>stderr_decode &
decoder=$!
for i in 0 1 2 3; do
  cp "drive/velodyne/000000000$i.bin" "live/.$i.bin" # hidden: still being written
  mv "live/.$i.bin" "live/$i.bin"
  wait_for "live_out/00000$i.bin"
done
[[ ! -e live_out/000004.bin ]] || fail "a sweep that was never there"
exec {slow}>live/4.bin # is complete once it is closed
head -c 1000 drive/velodyne/0000000004.bin >&"$slow"
cp drive/velodyne/0000000000.bin live/10.bin # comes after 4.bin
sleep 0.2
[[ ! -e live_out/000004.bin ]] || fail "a sweep was taken before it was complete"
tail -c +1001 drive/velodyne/0000000004.bin >&"$slow"
exec {slow}>&-
wait_for live_out/000005.bin
kill -INT "$encoder"
wait "$encoder" || fail "encode --follow ended with $?"
wait "$decoder" || fail "decode of a live stream ended with $?"
for i in 0 1 2 3 4; do same_file "live_out/00000$i.bin" "from_file/00000$i.bin"; done
cp stderr_encode stderr && cp stdout_decode stdout
says stderr "6 sweeps"
says stderr "ms from arrival to packet ("
is_empty stderr_decode
run 0 info piped.reel --json
json "r['complete'] is True and r['frames'] == 6"

# Sweeps that are there already, a late one, one that is damaged, and the end after --idle seconds.
mkdir folder
cp drive/velodyne/000000000{0,1}.bin folder
touch -d "1 minute ago" folder/*
(sleep 0.5 && head -c 1001 drive/velodyne/0000000002.bin >folder/0000000002.bin && cp drive/velodyne/0000000003.bin folder) &
run 3 encode --follow folder -o follow.reel --idle 2 --json
says stderr "folder/0000000002.bin"
json "r['frames'] == 3 and r['latency_ms']['sweeps'] == 1"
json "0 < r['latency_ms']['p50'] <= r['latency_ms']['p99'] <= r['latency_ms']['max'] < 2000"
run 0 verify follow.reel drive/velodyne/000000000{0,1,3}.bin
mkdir nothing
run 1 encode --follow nothing -o nothing.reel --idle 0.1
says stderr "nothing: no sweep came"
[[ ! -e nothing.reel ]] || fail "an output without a sweep"
run 1 encode --follow missing -o missing.reel
says stderr "--follow: cannot watch folder 'missing'"

# Standard input: sweeps one after another give the bytes that files give.
for format in pcd ply; do
  run 0 encode "$format" -o "$format.reel"
  cat "$format"/* | "$pointreel" encode - -o "$format.live.reel" >stdout 2>stderr || fail "encode - of $format"
  same_file "$format.reel" "$format.live.reel"
done
matches_expected encode_live
cat pcd/000000.pcd ply/000001.ply | "$pointreel" encode - -o mixed.reel --json >stdout 2>stderr
json "r['frames'] == 2 and r['latency_ms']['sweeps'] == 2"
# A pipe that stays open: each sweep comes out before the next one goes in.
mkfifo sweeps
"$pointreel" encode - -o - <sweeps 2>stderr | "$pointreel" decode - -o pipe_out >stdout &
decoder=$!
exec {pipe}>sweeps
for i in 0 1 2; do
  cat "pcd/00000$i.pcd" >&"$pipe"
  wait_for "pipe_out/00000$i.bin"
done
exec {pipe}>&-
wait "$decoder" || fail "decode of a live stream ended with $?"

# What is no sweep ends the stream; those before it are kept.
code=0
{ cat pcd/000000.pcd drive/velodyne/0000000000.bin; } | "$pointreel" encode - -o kitti.reel >stdout 2>stderr || code=$?
((code == 3)) || fail "exit code $code after a sweep of another format"
says stderr "standard input, sweep 1, line 1: is "
run 0 info kitti.reel
code=0
{ cat pcd/000000.pcd && head -c 2000 pcd/000001.pcd; } | "$pointreel" encode - -o cut.reel >stdout 2>stderr || code=$?
((code == 3)) || fail "exit code $code after a cut sweep"
says stderr "standard input, sweep 1: the stream ends within it, after 2000 bytes"
run 1 encode - -o none.reel </dev/null
says stderr "-: no sweep came"

# Damaged and missing packets: what is whole behind them comes through, and what is missing is named.
# Each sweep by itself, so that a lost one costs no other.
run 0 encode drive -o apart.reel --no-temporal
run 0 decode apart.reel -o from_apart
run 0 info apart.reel -v --json
read -ra begins < <(python3 -c "
import json
begin = 52
for packet in json.load(open('stdout'))['packets']: print(begin, end=' '); begin += packet['bytes']
print(begin)")
cp apart.reel damaged.reel
printf '\xA5\x5A\xA5' | dd of=damaged.reel bs=1 seek=$((begins[1] + 60)) conv=notrunc status=none
printf '\xFF\xFF\xFF\x0F' | dd of=damaged.reel bs=1 seek=$((begins[3] + 4)) conv=notrunc status=none # its length
for input in damaged.reel -; do
  rm -rf damaged
  run 3 decode "$input" -o damaged --json <damaged.reel
  says stderr "packet at byte ${begins[1]}: "
  says stderr "packet at byte ${begins[3]}: damaged, another one begins within it, at byte ${begins[4]}"
  says stderr "goes on with frame 2"
  says stderr "missing: frames 1, 3"
  json "r['frames'] == 3 and r['data_lost'] is True and r['missing_frames'] == [[1, 1], [3, 3]]"
  for i in 0 2 4; do same_file "damaged/00000$i.bin" "from_apart/00000$i.bin"; done
done
{ head -c "${begins[1]}" apart.reel && tail -c +$((begins[3] + 1)) apart.reel; } >lost.reel
run 3 decode - -o lost <lost.reel
says stderr "missing: frames 1 to 2"
