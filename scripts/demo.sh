#!/usr/bin/env bash
# From a fresh Debian 12 to a noise model with its intervals, on simulated gyro recordings whose true
# noise is known; then an effect hidden in emulated sensors is found; then the daemon records emulated
# sensors and calibrates them; at last the page shows the hidden effect. Needs no sensor. The reports are left in build/demo-output/.
#
#   bash scripts/demo.sh [--hide fan|mains|step|outliers|warm_up|temperature]     else one is drawn, and sealed
set -euo pipefail
# shellcheck source=scripts/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

hide=""
case ${1:-} in
  --hide) hide=${2:?"--hide needs the name of an effect"} ;;
  "") ;;
  *)
    echo "usage: $0 [--hide fan|mains|step|outliers|warm_up|temperature]" >&2
    exit 2
    ;;
esac

# A MEMS gyro: angle random walk 0.17 °/√h, a bias that wanders by 20 °/h with a memory of 5 s, and
# slowly without bound. Six static recordings of one hour at 100 Hz show all four parameters.
truth="WN(sigma2=2.5e-7) + AR1(sigma2=4e-11, phi=0.998) + RW(gamma2=5e-14)"
model="WN + AR1 + RW"
out=build/demo-output

bash scripts/install_packages.sh build
echo "Building imunoise (the first time takes some minutes) ..."
configure demo
compile demo imunoise imunoised imunoise_plugins
imunoise=build/demo/imunoise

rm -rf "$out"
mkdir -p "$out"
echo "Simulating six replicates: $truth"
"$imunoise" simulate --model "$truth" --rate 100 --samples 360000 --replicates 6 --seed 42 \
  --unit rad/s --out "$out/gyro.h5" > "$out/simulate.txt"
recordings=("$out"/gyro_{1..6}.h5)

echo
echo "imunoise fit $out/gyro_*.h5 --model \"$model\""
echo
"$imunoise" fit "${recordings[@]}" --model "$model" --report "$out/report.html"
"$imunoise" fit "${recordings[@]}" --model "$model" --json > "$out/fit.json"

echo
echo "Fitted and true values (95 % intervals: one in twenty misses the true value):"
awk -v truth="$truth" -f scripts/fit_against_truth.awk "$out/fit.json"

echo
echo "The report: file://$PWD/$out/report.html"
echo "The same as JSON: $out/fit.json"

echo
bash scripts/hide_effect.sh "$imunoise" "$out" "$hide"

echo
bash scripts/record_campaign.sh build/demo "$out"

echo
if [[ -t 1 && -z ${CI:-} ]]; then
  echo "Find the hidden effect yourself, in the browser (Ctrl-C ends the demo):"
  exec "$imunoise" open "$out/hidden" --channel emulated/imu/gyro_x
fi
echo "Find the hidden effect yourself, in the browser:"
echo "  $imunoise open $out/hidden --channel emulated/imu/gyro_x"
