#!/usr/bin/env bash
# Compresses a simulated drive, verifies every point and draws one sweep before and after. Needs a release build.
set -euo pipefail
cd "$(dirname "$(realpath "${BASH_SOURCE[0]}")")/.."

pointreel=build/release/tools/pointreel/pointreel
out=out/demo
rm -rf "$out"
mkdir -p "$out"

"$pointreel" simulate -o "$out/drive" --frames 20
"$pointreel" encode "$out/drive" -o "$out/drive.reel" --threshold 10cm --poses "$out/drive/poses.txt"
"$pointreel" verify "$out/drive.reel" "$out/drive"
"$pointreel" decode "$out/drive.reel" -o "$out/decoded"

original=$(find "$out/drive" -name '*.bin' | sort | sed -n 10p)
decoded=$(find "$out/decoded" -name '*.bin' | sort | sed -n 10p)
# Debian's Python is the one that `./dev demo` gave NumPy, SciPy and Matplotlib to.
/usr/bin/python3 examples/demo_picture.py "$original" "$decoded" "$out/range_image.png"
echo "picture: $out/range_image.png"
