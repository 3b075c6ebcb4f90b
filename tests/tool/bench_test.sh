#!/usr/bin/env bash
# bench: every codec on the same sweeps.
# shellcheck source-path=SCRIPTDIR
source "$(dirname "$0")/support.sh" "$@"

run 0 simulate -o drive --frames 2 --sensor vlp-16
run 0 bench --help
is_empty stderr
matches_expected help_bench
run 0 bench --list
says stdout "mixture"
says stdout "planes"
run 0 bench --codecs mixture,planes drive --poses drive/poses.txt --nearest 1
for words in "mixture balanced" "max error 2 cm" "planes uniform" "threshold 10 cm" "bits per input point"; do
  says stdout "$words"
done
is_empty stderr

# A line of JSON for each setting.
run 0 bench drive --codecs mixture --nearest 1 --json
is_empty stderr
python3 - <<'PYTHON' || fail "the JSON lines"
import json
lines = [json.loads(line) for line in open("stdout")]
assert len(lines) == 15
for r in lines:
    assert r["codec"] == "mixture" and r["failures"] == [] and r["sweeps"] == 2 and r["threads"] == 1
    assert sum(r["bytes_of_sweep"]) <= r["bytes"] and len(r["bytes_of_sweep"]) == 2
    assert abs(r["bits_per_point"] * r["points_in"] / 8 - r["bytes"]) < 1
    assert abs(r["ratio_xyz32"] * r["bits_per_point"] - 96) < 1e-9
    assert abs(r["ratio_xyzi32"] * r["bits_per_point"] - 128) < 1e-9
    assert r["points_in"] == r["points_out"] and r["keeps_order"] and r["keeps_count"]
    bound_m = float(r["settings"].split()[2]) / 100
    assert bound_m / 2 < r["own_error"]["max_m"] <= bound_m + 1e-6
    for side in ("nearest_decoded", "nearest_original"):
        e = r[side]
        assert 0 < e["mean_m"] <= e["rms_m"] <= e["max_m"] <= bound_m + 1e-6 and e["p95_m"] <= e["max_m"]
    assert [peak["peak_m"] for peak in r["psnr"]] == [59.7, 30] and r["psnr"][0]["d1_db"] > r["psnr"][1]["d1_db"]
    assert 0 < r["encode_ms"]["median"] <= r["encode_ms"]["p95"] and r["peak_memory_mib"] > 0
PYTHON

run 2 bench
says stderr "INPUT"
run 2 bench drive --codecs zip
says stderr "'zip' is none of"
run 2 bench drive --repeat 0
run 1 bench missing_folder --codecs mixture
says stderr "missing_folder"

# The tool alone, as installed, says what it lacks.
mkdir alone
cp "$pointreel" alone/pointreel
code=0
alone/pointreel bench drive >stdout 2>stderr || code=$?
((code == 1)) || fail "exit code $code without pointreel-bench"
says stderr "pointreel-bench: not found"
