#!/usr/bin/env bash
# Lets imunoised record a campaign of three emulated sensors behind their real drivers, six replicates, and calibrate
# it; shows the table and the address of the page.
#
#   bash scripts/record_campaign.sh BUILD FOLDER
set -euo pipefail
build=$1
out=$2
absolute=$(realpath -m "$out")

rm -rf "$out/bench" "$out/bench.toml"
mkdir -p "$out/bench"
# An ADIS16405 twenty times faster than real; the others keep time, at a higher rate.
cat > "$out/bench.toml" << CAMPAIGN
name = "bench"
folder = "$absolute/bench"
length = "8 s"
replicates = 6
reserve = "100 MB"
[calibration]
models = ["WN + RW"]
diagnose = false
[[device]]
name = "adis16405"
driver = "emulated"
options.device = "adis16405"
options.speed = 20
options.seed = 1
options.model = ["gyro: WN(sigma2=9e-6) + RW(gamma2=1e-11)", "acc: WN(sigma2=1e-4)"]
[[device]]
name = "mti-g"
driver = "emulated"
options.device = "xsens"
options.rate = 400
options.seed = 2
options.model = ["gyro: WN(sigma2=4e-6) + RW(gamma2=1e-11)", "acc: WN(sigma2=1e-4)"]
[[device]]
name = "can-imu"
driver = "emulated"
options.device = "can"
options.rate = 400
options.seed = 3
options.model = ["gyro: WN(sigma2=6e-6) + RW(gamma2=1e-11)", "acc: WN(sigma2=1e-4)"]
CAMPAIGN

echo "imunoised --once $out/bench.toml     (six replicates of 8 s: about a minute)"
"$build/imunoised" --once "$out/bench.toml" > "$out/bench.log" 2>&1 ||
  { tail -n 20 "$out/bench.log" >&2 && exit 1; }
recording=$(find "$out/bench" -mindepth 1 -maxdepth 1 -type d)

echo
echo "imunoise calibrations $out/bench"
"$build/imunoise" calibrations "$out/bench"

# imunoised has calibrated it; the same again makes the page.
echo
echo "imunoise calibrate $recording --model \"WN + RW\" --no-diagnose --report $out/bench.html"
"$build/imunoise" calibrate "$recording" --model "WN + RW" --no-diagnose --report "$out/bench.html" \
  2> "$out/calibrate.txt" | sed '/: \(fits\|does not fit\|no model\)$/,$d'
echo "The page: file://$absolute/bench.html"
