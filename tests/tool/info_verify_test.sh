#!/usr/bin/env bash
# encode, info and verify of method planes: texts, JSON, and agreement between them.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "$0")/support.sh" "$@"

run 0 simulate -o drive --frames 5 --sensor vlp-16
matches_expected simulate
run 0 encode drive -o drive.reel --method planes --grid uniform --elevation-step 2deg --group 3
matches_expected encode_planes
is_empty stderr
run 0 encode drive -o again.reel --method planes --grid uniform --elevation-step 2deg --group 3 --threads 1 --json
same_file drive.reel again.reel
bytes=$(stat -c %s drive.reel)
json "r['frames'] == 5 and r['bytes'] == $bytes and r['bound_m'] == 0.1 and r['bound_kind'] == 'range'"
json "r['points'] == r['points_kept'] + r['points_lost'] + r['points_non_finite']"
json "abs(r['bits_per_point'] - 8 * r['bytes'] / r['points']) < 1e-6"
json "abs(r['ratio_xyz32'] * r['bits_per_point'] - 96) < 1e-6"
json "abs(sum(r['bits_by_part'].values()) - 8 * r['bytes']) < 1 and min(r['bits_by_part'].values()) > 0"
json "sum(r['cells'].values()) == r['points_kept'] and r['fields_left_out'] == ['intensity']"
json "r['ms_per_frame']['p95'] >= r['ms_per_frame']['median'] > 0"
cp stdout encoded.json

run 0 info drive.reel
matches_expected info_planes
run 0 info drive.reel -v
matches_expected info_planes_verbose
run 0 info drive.reel -v --json
is_empty stderr
json "r['points_in'] == json.load(open('encoded.json'))['points'] and r['complete'] is True"
json "r['threshold_m'] == 0.1 and abs(r['elevation_step_deg'] - 2) < 1e-9 and r['group'] == 3"
json "[p['frame'] for p in r['packets']] == [1, 0, 2, 4, 3] and r['key_frames'] == 2"
json "sum(p['points_out'] for p in r['packets']) == r['points_out']"
json "52 + r['packet_bytes'] < $bytes"

run 0 verify drive.reel drive
matches_expected verify_planes
is_empty stderr
run 0 verify drive.reel drive --json
is_empty stderr
json "r['frames'] == 5 and r['frames_missing'] == 0 and r['bound_held'] is True and r['bound_m'] == 0.1"
json "r['points_in'] == r['points_out'] + r['points_lost'] + r['points_non_finite']"
json "0 < r['range_error']['max_m'] <= 0.1001 and r['range_error']['count'] == r['points_out']"
json "r['mean_error_m'] <= r['rmse_m'] <= r['max_error_m']"

# Other options hold their bounds as well.
for options in "--threshold 2cm" "--residual-step raw" "--group 1 --tile 7" "--residual-step 60cm" "--threshold 10m"; do
  # shellcheck disable=SC2086
  run 0 encode drive -o other.reel -f --method planes --grid uniform --elevation-step 2deg $options
  run 0 verify other.reel drive --json
  json "r['bound_held'] is True"
done

# Points 10 km away have coordinates in steps of 1 mm: that rounding is not held against the bound.
mkdir far
python3 - >far/0.bin <<'PYTHON'
import math, random, struct, sys
random.seed(1)
for _ in range(500):
    azimuth, elevation, r = random.uniform(-3, 3), random.uniform(-1, 1), random.uniform(8000, 12000)
    x, y = (r * math.cos(elevation) * f(azimuth) for f in (math.cos, math.sin))
    sys.stdout.buffer.write(struct.pack("<4f", x, y, r * math.sin(elevation), 0))
PYTHON
for threshold in 1mm 10cm; do
  run 0 encode far -o far.reel -f --method planes --grid uniform --threshold $threshold
  run 0 verify far.reel far
done

# Against the wrong originals.
run 0 simulate -o other --frames 5 --sensor vlp-16 --seed 99
run 1 verify drive.reel other
says stderr "not the same sweep"
run 1 verify drive.reel drive/velodyne/000000000{0,1}.bin
says stderr "only 2 originals were given"
run 0 encode drive/velodyne/0000000000.bin drive/velodyne/0000000001.bin -o two.reel --method planes --grid uniform --elevation-step 2deg
run 3 verify two.reel drive
says stderr "3 of the 5 originals are not in it"

# An unreadable input ends the drive there; what came before it is kept.
head -c 1001 drive/velodyne/0000000003.bin >broken && mv broken drive/velodyne/0000000003.bin
run 3 encode drive -o partial.reel --method planes --grid uniform
says stderr "0000000003.bin"
says stderr "partial.reel holds the 3 sweeps before the fault"
run 0 info partial.reel --json
json "r['frames'] == 3 and r['complete'] is True"
