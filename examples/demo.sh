#!/usr/bin/env bash
# Compresses a simulated drive by both methods, verifies every point and draws one sweep before and after. Needs a
# release build.
set -euo pipefail
cd "$(dirname "$(realpath "${BASH_SOURCE[0]}")")/.."

pointreel=build/release/tools/pointreel/pointreel
out=out/demo
rm -rf "$out"
mkdir -p "$out"

"$pointreel" simulate -o "$out/drive" --frames 20
original=$(find "$out/drive" -name '*.bin' | sort | sed -n 10p)

# show METHOD OPTIONS...: there and back, with a picture.
show() {
  local method=$1
  echo
  echo "== method $method"
  "$pointreel" encode "$out/drive" -o "$out/$method.reel" --method "$method" "${@:2}"
  "$pointreel" verify "$out/$method.reel" "$out/drive"
  "$pointreel" decode "$out/$method.reel" -o "$out/$method"
  # Debian's Python is the one that `./dev demo` gave NumPy, SciPy and Matplotlib to.
  /usr/bin/python3 examples/demo_picture.py "$original" "$(find "$out/$method" -name '*.bin' | sort | sed -n 10p)" \
    "$out/$method.png"
}
show mixture --max-error 2cm
show planes --max-error 10cm
