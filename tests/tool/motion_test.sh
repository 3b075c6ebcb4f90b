#!/usr/bin/env bash
# encode with --poses and --imu on a drive that moves.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "$0")/support.sh" "$@"
run 0 simulate -o drive --frames 6 --sensor vlp-16
[[ $(wc -l <drive/poses.txt) == 6 && $(wc -l <drive/times.txt) == 6 ]] || fail "a pose and a time per sweep"
options=(--method planes --grid uniform --elevation-step 2deg --group 6 --json)

run 0 encode drive -o still.reel "${options[@]}"
run 0 encode drive -o poses.reel --poses drive/poses.txt "${options[@]}"
run 0 encode drive -o imu.reel --imu drive/imu.csv "${options[@]}"
cmp -s still.reel poses.reel && fail "poses made no difference"
cmp -s still.reel imu.reel && fail "the IMU made no difference"
for reel in still poses imu; do
  run 0 verify $reel.reel drive --json
  json "r['bound_held'] is True and r['points_lost'] < r['points_in'] / 2"
done

# The same poses with times (TUM), in a drive whose times.txt says when its sweeps were.
python3 - <<'PYTHON'
import math
with open("tum.txt", "w") as out:
    for time, line in zip(open("drive/times.txt"), open("drive/poses.txt")):
        m = [float(word) for word in line.split()]
        w = math.sqrt(max(0, 1 + m[0] + m[5] + m[10])) / 2
        q = [(m[9] - m[6]) / (4 * w), (m[2] - m[8]) / (4 * w), (m[4] - m[1]) / (4 * w), w]
        print(time.strip(), m[3], m[7], m[11], *q, file=out)
PYTHON
run 0 encode drive -o tum.reel --poses tum.txt "${options[@]}"
run 0 verify tum.reel drive --json
json "r['bound_held'] is True"

# Files that do not fit name themselves.
head -n 2 drive/poses.txt >few.txt
run 1 encode drive -o a.reel --method planes --grid uniform --poses few.txt
says stderr "few.txt: holds 2 entries for 6 sweeps"
awk '{ $1 += 1000; print }' tum.txt | head -n 4 >other_day.txt
run 1 encode drive -o a.reel --method planes --grid uniform --poses other_day.txt
says stderr "other_day.txt: "
run 1 encode drive -o a.reel --method planes --grid uniform --poses missing.txt
says stderr "missing.txt"
run 1 encode drive -o a.reel --method planes --grid uniform --imu missing.csv
says stderr "missing.csv"
echo "t,ax" >bad.csv && echo "1,2" >>bad.csv
run 1 encode drive -o a.reel --method planes --grid uniform --imu bad.csv
says stderr "bad.csv:"
[[ ! -e a.reel ]] || fail "an output although the motion could not be read"
