#!/usr/bin/env bash
# Method planes on the sensor's grid: encode, info, verify, and the planes themselves.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "$0")/support.sh" "$@"

run 0 simulate -o drive --frames 5 --sensor vlp-16
run 0 encode drive -o drive.reel --method planes --max-error 10cm
matches_expected encode_sensor_planes
run 0 info drive.reel
matches_expected info_sensor_planes
run 0 verify drive.reel drive
says stdout "error bound 0.1 m for every point: held"
run 0 verify drive.reel drive --json
json "r['method'] == 'planes' and r['points_lost'] == 0 and r['max_error_m'] <= 0.1 and r['order_preserved']"
json "r['fields']['intensity']['exact']"
run 0 encode drive -o fast.reel --method planes --grid sensor --max-error 10cm --effort fast --fields none --json
json "r['bound_kind'] == 'space' and r['cells']['spatial'] > r['cells']['unfit'] and r['cells']['temporal'] == 0"
json "r['fields_left_out'] == ['intensity'] and r['bits_by_part']['planes'] > 0"
run 0 info fast.reel --json
json "r['grid'] == 'sensor' and r['effort'] == 'fast' and r['points_lost'] == 0"

# As JSON, as PLY, from a pipe, and only some.
run 0 planes drive.reel -o planes.json
says stdout "planes of 5 sweeps"
cp planes.json stdout
json "[s['frame'] for s in r['sweeps']] == [0, 1, 2, 3, 4]"
json "all(abs(sum(x * x for x in p['normal']) - 1) < 1e-6 and p['distance_m'] > 0 and p['cells'] >= 8 for s in r['sweeps'] for p in s['planes'])"
json "any(p['reused'] for p in r['sweeps'][1]['planes']) and not any(p['reused'] for p in r['sweeps'][0]['planes'])"
"$pointreel" planes - -o piped.json <drive.reel >stdout 2>stderr || fail "planes of a pipe"
same_file planes.json piped.json
run 1 planes drive.reel -o planes.json
says stderr "exists; -f overwrites it"
run 0 planes drive.reel -o planes.json -f --frames 1:3
cp planes.json stdout
json "[s['frame'] for s in r['sweeps']] == [1, 2]"
run 0 planes drive.reel -o planes.ply --frames 4
says stdout "planes of 1 sweeps"
head -c 300 planes.ply | grep -qa "^property uint plane" || fail "no planes.ply"

# What has no planes, and what is damaged.
run 0 encode drive -o mixture.reel
run 0 encode drive -o uniform.reel --method planes --grid uniform --elevation-step 2deg
for other in mixture uniform; do
  run 1 planes $other.reel -o none.json
  says stderr "$other.reel: only --method planes --grid sensor keeps planes"
done
run 1 planes missing.reel -o none.json
[[ ! -e none.json ]] || fail "an output without planes"
head -c $(($(stat -c %s drive.reel) * 2 / 3)) drive.reel >cut.reel
run 3 planes cut.reel -o cut.json
