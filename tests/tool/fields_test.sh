#!/usr/bin/env bash
# encode --fields: which fields come back, and how far they may be off.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "$0")/support.sh" "$@"

# Sweeps with a ring and a time of each point, as drivers store them.
run 0 simulate -o drive --frames 2 --sensor vlp-16
mkdir sweeps
for i in 0 1; do
  python3 - "drive/velodyne/000000000$i.bin" sweeps/$i.pcd <<'PYTHON'
import math, struct, sys
points = list(struct.iter_unpack("<4f", open(sys.argv[1], "rb").read()))
with open(sys.argv[2], "wb") as out:
    out.write(f"""VERSION 0.7
FIELDS x y z intensity ring time
SIZE 4 4 4 4 2 8
TYPE F F F F U F
COUNT 1 1 1 1 1 1
WIDTH {len(points)}
HEIGHT 1
VIEWPOINT 0 0 0 1 0 0 0
POINTS {len(points)}
DATA binary
""".encode())
    for i, (x, y, z, intensity) in enumerate(points):
        ring = round((math.degrees(math.atan2(z, math.hypot(x, y))) + 15) / 2)
        out.write(struct.pack("<4fHd", x, y, z, intensity, ring, 1.7e9 + 5e-6 * i))
PYTHON
done

encode_fields() {
  run 0 encode sweeps -o drive.reel -f --fields "$1" --json
  cp stdout encoded.json
  run 0 verify drive.reel sweeps --json
}
encode_fields all
json "sorted(r['fields']) == ['intensity', 'ring', 'time'] and all(f['exact'] for f in r['fields'].values())"
json "r['order_preserved'] is True"
exact_bytes=$(stat -c %s drive.reel)
run 0 decode drive.reel -o out --format pcd
run 0 verify drive.reel out/*.pcd --json
json "r['max_error_m'] == 0 and len(r['fields']) == 3"
run 0 decode drive.reel -o out --format ply
run 0 decode drive.reel -o out --format kitti
for i in 0 1; do
  python3 - "drive/velodyne/000000000$i.bin" "out/00000$i.bin" <<'PYTHON' || fail "intensity of sweep $i"
import struct, sys
before, after = (list(struct.iter_unpack("<4f", open(name, "rb").read())) for name in sys.argv[1:])
assert [p[3] for p in before] == [p[3] for p in after]
PYTHON
done

encode_fields all,intensity:0.05,time:1e-3
json "r['fields']['ring']['exact'] is True and r['fields']['intensity']['exact'] is False"
json "0 < r['fields']['intensity']['max_difference'] <= 0.05 and r['fields']['time']['max_difference'] <= 1e-3"
json "json.load(open('encoded.json'))['fields']['intensity'] == {'step': 0.05}"
[[ $(stat -c %s drive.reel) -lt $exact_bytes ]] || fail "steps that save nothing"
encode_fields ring,time:0
json "sorted(r['fields']) == ['ring', 'time'] and all(f['exact'] for f in r['fields'].values())"
json "json.load(open('encoded.json'))['fields_left_out'] == ['intensity']"
run 0 encode sweeps -o drive.reel -f --fields ring,intensity:0.1
says stdout "intensity (within 0.1), ring (exact)"
says stdout "left out        time"
encode_fields none
json "r['fields'] == {} and r['bits_per_point_with_fields'] < r['bits_per_point'] + 0.01"

# A format that has no room for a field, or wants one that is not there, is written as ever.
run 0 decode drive.reel -o out --format kitti -f
run 1 encode sweeps -o other.reel --fields all,speed:1
says stderr "0.pcd has no field speed (it has intensity, ring, time)"
[[ ! -e other.reel ]] || fail "an output although a field is missing"

# Originals with other fields are told from these.
run 0 encode sweeps -o drive.reel -f
run 1 verify drive.reel drive/velodyne
says stderr "not the same sweep"
