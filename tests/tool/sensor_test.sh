#!/usr/bin/env bash
# info --sensor: the sensor behind the sweeps.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "$0")/support.sh" "$@"

run 0 simulate -o drive --frames 3 --sensor vlp-16
run 0 info --sensor drive
matches_expected sensor
is_empty stderr
run 0 info --sensor -v drive
matches_expected sensor_verbose
run 0 info --sensor drive/velodyne/*.bin -v --json
is_empty stderr
json "r['grid_found'] is True and r['sweeps'] == r['sweeps_given'] == 3 and r['rows'] == 16"
json "abs(r['elevation_deg']['lowest'] + 15) < 0.1 and abs(r['elevation_deg']['highest'] - 15) < 0.1"
json "r['ticks_per_turn'] == 1800 and abs(r['columns_per_sweep'] - 1800) < 10 and 0.5 < r['occupancy'] <= 1"
json "r['points_on_grid'] + sum(r['points_off_grid'].values()) == r['points']"
json "0 < r['residual_m']['p50'] <= r['residual_m']['p95'] <= r['residual_m']['p99'] <= r['residual_m']['max'] < 0.05"
json "r['sweeps_in_order'] == 3 and r['motion_compensated'] is False and r['has_rings'] is False"
json "len(r['row_table']) == 16 and r['row_table'][0]['elevation_deg'] > r['row_table'][15]['elevation_deg']"

# At most twenty sweeps of a long drive are looked at.
mkdir long
for i in $(seq 30); do ln -s "$folder/drive/velodyne/0000000000.bin" "long/$i.bin"; done
run 0 info --sensor long --json
json "r['sweeps'] == 20 and r['sweeps_given'] == 30"

# No sensor at all.
python3 - >box.bin <<'PYTHON'
import random, struct, sys
random.seed(1)
for _ in range(2000): sys.stdout.buffer.write(struct.pack("<4f", *(random.uniform(-9, 9) for _ in range(4))))
PYTHON
run 0 info --sensor box.bin
says stdout "no grid"
run 0 info --sensor box.bin --json
json "r['grid_found'] is False and r['points'] == 2000"
run 1 info --sensor missing_folder
says stderr "missing_folder"
