#!/usr/bin/env bash
# decode of method planes: every format, ranges of frames, damaged reels.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "$0")/support.sh" "$@"
make_planes_drive

files_of() {
  (cd "$1" && echo *)
}
expect_files() {
  [[ $(files_of "$1") == "$2" ]] || fail "$1 holds $(files_of "$1") instead of $2"
}

run 0 decode drive.reel -o kitti
matches_expected decode
is_empty stderr
expect_files kitti "000000.bin 000001.bin 000002.bin 000003.bin 000004.bin"
for format in nuscenes:.pcd.bin pcd:.pcd ply:.ply; do
  extension=${format#*:} format=${format%:*}
  run 0 decode drive.reel -o "$format" --format "$format" --json
  is_empty stderr
  json "r['frames'] == 5 and r['points'] > 5000 and r['data_lost'] is False"
  expect_files "$format" "000000$extension 000001$extension 000002$extension 000003$extension 000004$extension"
done

# Ranges of frames give the same files as the whole.
for range in 1:3=1,2 3:=3,4 :2=0,1 4=4; do
  wanted=${range#*=} range=${range%=*}
  run 0 decode drive.reel -o "range$range" --frames "$range"
  files=""
  for frame in ${wanted//,/ }; do
    same_file "range$range/00000$frame.bin" "kitti/00000$frame.bin"
    files+="${files:+ }00000$frame.bin"
  done
  expect_files "range$range" "$files"
done
run 1 decode drive.reel -o none --frames 7:9
says stderr "--frames: drive.reel has no frame in 7:9"

run 1 decode drive.reel -o kitti
says stderr "kitti/000001.bin: exists; -f overwrites it"
run 0 decode drive.reel -o kitti -f
run 0 decode drive.reel -o one_thread --threads 1
for file in kitti/*; do same_file "$file" "one_thread/${file#*/}"; done

# Cut off in the last group: the sweeps before it are kept, and the loss is told (exit code 3).
bytes=$(stat -c %s drive.reel)
head -c $((bytes - 400)) drive.reel >cut.reel
run 3 decode cut.reel -o cut
says stderr "cut.reel: packet at byte"
for frame in 0 1 2; do same_file "cut/00000$frame.bin" "kitti/00000$frame.bin"; done
run 3 decode cut.reel -o cut_range --frames 0:2 --json
json "r['frames'] == 2 and r['data_lost'] is True"
run 3 info cut.reel --json
json "r['complete'] is False and r['frames'] >= 3"
run 3 verify cut.reel drive
says stderr "of the 5 originals are not in it"

# A damaged packet in the middle: --frames reaches the ones behind it by the index.
run 0 info drive.reel -v --json
offset=$(python3 -c "import json; p = json.load(open('stdout'))['packets']; print(52 + p[0]['bytes'] + 60)")
cp drive.reel damaged.reel
printf '\xA5\x5A\xA5' | dd of=damaged.reel bs=1 seek="$offset" conv=notrunc status=none
run 3 decode damaged.reel -o damaged --frames 0:5
says stderr "checksum does not match"
expect_files damaged "000001.bin 000002.bin 000003.bin 000004.bin"
for file in damaged/*; do same_file "$file" "kitti/${file#*/}"; done

# Nothing but a header.
head -c 52 drive.reel >header.reel
run 3 decode header.reel -o header
head -c 51 drive.reel >less.reel
run 1 decode less.reel -o less
says stderr "less.reel: stream ends within its header"
