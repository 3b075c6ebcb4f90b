#!/usr/bin/env bash
# Method mixture, the default: every point through files and back, and what encode, info and verify say of it.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "$0")/support.sh" "$@"

run 0 simulate -o drive --frames 5 --sensor vlp-16
run 0 encode drive -o drive.reel --group 3
matches_expected encode
is_empty stderr
run 0 encode drive -o again.reel --group 3 --max-error 0.02 --method mixture --threads 1 --json
same_file drive.reel again.reel
bytes=$(stat -c %s drive.reel)
json "r['method'] == 'mixture' and r['frames'] == 5 and r['bytes'] == $bytes"
json "r['bound_m'] == r['max_error_m'] == 0.02 and r['bound_kind'] == 'space'"
json "r['points'] == r['points_kept'] and r['points_lost'] == r['points_non_finite'] == 0"
json "abs(r['bits_per_point_with_fields'] - 8 * r['bytes'] / r['points']) < 1e-6"
json "abs(r['bits_per_point'] * r['points'] + r['bits_by_part']['fields'] - 8 * r['bytes']) < 1"
json "abs(r['ratio_xyz32'] * r['bits_per_point'] - 96) < 1e-6"
json "abs(sum(r['bits_by_part'].values()) - 8 * r['bytes']) < 1 and min(r['bits_by_part'].values()) >= 0"
json "set(r['bits_by_part']) == {'model', 'grid', 'occupancy', 'ranges', 'order', 'corrections', 'strays',
      'scattered', 'fields', 'container'}"
json "r['fields'] == {'intensity': {'step': 0}} and r['fields_left_out'] == []"
json "r['stray_points'] + r['corrected_points'] < 0.01 * r['points'] and r['scattered_sweeps'] == 0"
json "r['ms_per_frame']['p95'] >= r['ms_per_frame']['median'] > 0"
json "r['bits_per_point'] < 4"
cp stdout encoded.json

run 0 info drive.reel
matches_expected info
run 0 info drive.reel -v
matches_expected info_verbose
run 0 info drive.reel -v --json
is_empty stderr
json "r['method'] == 'mixture' and r['max_error_m'] == r['bound_m'] == 0.02 and r['group'] == 3"
json "r['points_in'] == json.load(open('encoded.json'))['points'] and r['complete'] is True"
json "[p['frame'] for p in r['packets']] == [0, 1, 2, 3, 4] and r['key_frames'] == 2"
json "sum(p['points_out'] for p in r['packets']) == r['points_out']"

run 0 verify drive.reel drive
matches_expected verify
is_empty stderr
run 0 verify drive.reel drive --json
is_empty stderr
json "r['frames'] == 5 and r['frames_missing'] == 0 and r['bound_held'] is True and r['bound_m'] == 0.02"
json "r['points_in'] == r['points_out'] and r['points_lost'] == 0 and r['order_preserved'] is True"
json "r['mean_error_m'] <= r['rmse_m'] <= r['max_error_m'] <= 0.02 and r['range_error']['count'] == r['points_in']"
json "r['fields'] == {'intensity': {'exact': True, 'max_difference': 0}} and r['frames_reordered'] == 0"
json "abs(r['bits_per_point'] - json.load(open('encoded.json'))['bits_per_point']) < 0.1"
json "r['bits_per_point_with_fields'] > r['bits_per_point'] + 0.5 and abs(r['ratio_xyz32'] * r['bits_per_point'] - 96) < 1e-6"
json "all(r[way]['p95'] >= r[way]['median'] > 0 for way in ('encode_ms', 'decode_ms'))"

# The files themselves: every point in its place, within the bound, with its intensity.
run 0 decode drive.reel -o kitti
matches_expected decode
for i in 0 1 2 3 4; do
  python3 - "drive/velodyne/000000000$i.bin" "kitti/00000$i.bin" <<'PYTHON' || fail "sweep $i is not as it was"
import math, struct, sys
before, after = (list(struct.iter_unpack("<4f", open(name, "rb").read())) for name in sys.argv[1:])
assert len(before) == len(after)
for p, q in zip(before, after):
    assert math.dist(p[:3], q[:3]) <= 0.02 and p[3] == q[3], (p, q)
PYTHON
done
for format in pcd:.pcd ply:.ply nuscenes:.pcd.bin; do
  extension=${format#*:} format=${format%:*}
  run 0 decode drive.reel -o "$format" --format "$format"
  run 0 verify drive.reel "$format"/*"$extension" --json
  json "r['max_error_m'] == 0 and r['fields']['intensity']['exact'] is True"
done
run 0 decode drive.reel -o range --frames 4
same_file range/000004.bin kitti/000004.bin
[[ $(echo range/*) == range/000004.bin ]] || fail "more than the wanted frame: $(echo range/*)"

# Through pipes, too.
"$pointreel" encode drive -o - --group 3 2>stderr | "$pointreel" decode - -o piped >stdout
for file in kitti/*; do same_file "$file" "piped/${file#*/}"; done

# Other bounds and groups.
for options in "--max-error 1mm" "--max-error 0.5m" "--group 1" "--no-temporal --fields none"; do
  # shellcheck disable=SC2086
  run 0 encode drive -o other.reel -f $options
  run 0 verify other.reel drive --json
  json "r['bound_held'] is True and r['points_lost'] == 0 and r['max_error_m'] > 0.3 * r['bound_m']"
done
json "r['fields'] == {}"

# Damage costs the sweeps that need what is lost.
head -c $((bytes - 400)) drive.reel >cut.reel
run 3 decode cut.reel -o cut
says stderr "cut.reel: packet at byte"
for frame in 0 1 2 3; do same_file "cut/00000$frame.bin" "kitti/00000$frame.bin"; done
run 3 verify cut.reel drive
says stderr "1 of the 5 originals are not in it"
says stdout "4 sweeps"
# Cut within the first sweep: nothing to claim anything of.
head -c 2000 drive.reel >first.reel
run 1 verify first.reel drive
says stdout "first.reel: no whole sweep in it, nothing was verified"
says stderr "first.reel: packet at byte 52"
says stderr "5 of the 5 originals are not in it"
run 1 verify first.reel drive --json
json "r['frames'] == 0 and r['bound_held'] is None"

# Efforts, each sweep by itself, and motion from a file.
for options in "--effort fast" "--effort max" --no-temporal "--motion none" "--poses drive/poses.txt" "--imu drive/imu.csv"; do
  # shellcheck disable=SC2086
  run 0 encode drive -o other.reel -f $options
  run 0 verify other.reel drive --json
  json "r['bound_held'] is True and r['points_lost'] == 0 and r['order_preserved'] is True"
done
run 0 encode drive -o fast.reel --effort fast
run 0 info fast.reel --json
json "r['effort'] == 'fast'"
run 0 encode drive -o apart.reel --no-temporal
(($(stat -c %s drive.reel) < $(stat -c %s apart.reel))) || fail "the sweep before saved nothing"
# The encoder that `verify` times does as the one that made the stream.
for reel in drive:True apart:False fast:False; do
  run 0 verify "${reel%:*}.reel" drive --json
  json "r['temporal'] is ${reel#*:}"
done
# One sweep out of the middle of a group.
run 0 decode drive.reel -o all
run 0 decode drive.reel -o one --frames 3:4
same_file one/000003.bin all/000003.bin

# Against the wrong originals: other points, and the same ones moved by 5 cm.
run 0 simulate -o other --frames 5 --sensor vlp-16 --seed 99
run 1 verify drive.reel other
says stderr "not the same sweep"
mkdir moved
for i in 0 1 2 3 4; do
  python3 - "drive/velodyne/000000000$i.bin" >moved/$i.bin <<'PYTHON'
import struct, sys
for x, y, z, intensity in struct.iter_unpack("<4f", open(sys.argv[1], "rb").read()):
    sys.stdout.buffer.write(struct.pack("<4f", x + 0.05, y, z, intensity))
PYTHON
done
run 1 verify drive.reel moved
says stdout "error bound 0.02 m for every point: BROKEN"
run 1 verify drive.reel moved --json
json "r['bound_held'] is False and 0.03 < r['max_error_m'] < 0.08"

# Clouds of no rotating sensor, points that are not finite, and nothing at all.
mkdir odd
python3 - <<'PYTHON'
import math, random, struct
random.seed(1)
def write(name, points):
    with open(name, "wb") as out:
        for i, point in enumerate(points): out.write(struct.pack("<4f", *point, i))
box = [[random.uniform(-20, 20) for _ in range(3)] for _ in range(2000)]
write("odd/0.bin", box)
write("odd/1.bin", [])
write("odd/2.bin", [[math.nan, 1, 2]] + box[:100] + [[1, math.inf, 2]])
PYTHON
run 0 encode odd -o odd.reel --json
json "r['points'] == 2102 + 0 and r['points_non_finite'] == 2 and r['points_lost'] == 0 and r['scattered_sweeps'] >= 2"
run 0 encode odd -o odd.reel -f
says stdout "without a grid"
run 0 verify odd.reel odd
says stdout "order not kept in 2 sweeps"
says stdout "fields of sweeps whose order is not kept cannot be compared"
run 0 verify odd.reel odd --json
json "r['bound_held'] is True and r['points_lost'] == 0 and r['points_non_finite'] == 2"
json "r['order_preserved'] is False and r['frames_reordered'] == 2"
