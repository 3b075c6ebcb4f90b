#!/usr/bin/env bash
# planes_study and imu_drift on three small simulated sweeps: every table is there, whole, and its values are sane.
#
# usage: planes_study_test.sh POINTREEL PLANES_STUDY IMU_DRIFT
set -euo pipefail
pointreel=$1
planes_study=$2
imu_drift=$3

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
drive=$scratch/drive
tables=$scratch/tables

fail() {
  echo "planes_study_test: $*" >&2
  exit 1
}

# table FILE ROWS CONDITION: FILE has ROWS rows, none with fewer or more values than its header or with a value that
# is no number, and CONDITION, an awk expression over v["column name"], holds in each.
table() {
  local file=$1 rows=$2 condition=$3
  [[ -f $file ]] || fail "$file is missing"
  awk -F, -v rows="$rows" '
    NR == 1 { for (i = 1; i <= NF; ++i) name[i] = $i; columns = NF; next }
    NF != columns || /nan|inf/ { print FILENAME ":" NR ": " $0; bad = 1 }
    { for (i = 1; i <= NF; ++i) v[name[i]] = $i }
    !('"$condition"') { print FILENAME ":" NR ": not as it should be: " $0; bad = 1 }
    END { if (NR - 1 != rows) { print FILENAME ": " NR - 1 " rows, not " rows; bad = 1 }; exit bad }
  ' "$file" || fail "$file is wrong, should have: $condition"
}

"$pointreel" simulate -o "$drive" --frames 3 --sensor vlp-16
"$planes_study" "$drive" --poses "$drive/poses.txt" --imu "$drive/imu.csv" --repeat 1 --nearest 1 \
  --threads 2 -o "$tables"
"$imu_drift" "$drive" --poses "$drive/poses.txt" --imu "$drive/imu.csv" -o "$tables/imu_drift.csv"

# The float32 rounding of decoded points comes on top of the bound.
sane='v["bpp"] > 0 && v["bpp"] < 40 && v["bytes"] * 8 - v["bpp"] * v["points"] < v["bytes"] / 100 &&
  v["kept_share"] > 0.1 && v["kept_share"] <= 1 && v["max_range_error_m"] <= v["range_bound_m"] + 1e-4 &&
  v["spatial_share"] + v["temporal_share"] + v["unfit_share"] > 0.999 &&
  v["mean_error_m"] <= v["rms_error_m"] && v["rms_error_m"] <= v["max_error_m"] &&
  v["nearest_decoded_mean_m"] > 0 && v["encode_ms"] > 0 && v["decode_ms"] > 0 && v["sweeps"] == 3'
# Groups of 5 hold all three sweeps.
table "$tables/threshold.csv" 10 "$sane"
table "$tables/resolution.csv" 20 "$sane"
table "$tables/tile.csv" 16 "$sane"
table "$tables/group.csv" 4 "$sane && (v[\"group\"] > 1 || v[\"temporal_share\"] == 0)" # 1 and 3
table "$tables/motion.csv" 6 "$sane"
table "$tables/speedup.csv" 2 'v["encode_speedup"] > 0 && v["decode_speedup"] > 0 && v["threads"] == 2'
table "$tables/imu_drift.csv" 3 'v["step_translation_error_m"] < 0.05 && v["drift_translation_m"] < 0.1'
