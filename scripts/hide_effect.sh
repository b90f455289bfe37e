#!/usr/bin/env bash
# Hides a physical effect in emulated gyros, lets imunoise find it, and opens the seal afterwards.
#
#   bash scripts/hide_effect.sh IMUNOISE FOLDER [EFFECT] [SEED]
#
# EFFECT: fan, mains, step, outliers, warm_up or temperature; drawn by the seed when it is not named.
set -euo pipefail

imunoise=$1
out=$2
seed=${4:-$((RANDOM))}
known=(fan mains step outliers warm_up temperature)
effect=${3:-}
if [[ -z $effect ]]; then effect=${known[seed % ${#known[@]}]}; fi

case $effect in
  fan) hidden="fan(frequency=13.7,amplitude=4e-4,harmonics=1,channel=gyro_x)" ;;
  mains) hidden="mains(amplitude=4e-4,channel=gyro_x)" ;;
  step) hidden="step(at=200,height=1e-3,channel=gyro_x)" ;;
  outliers) hidden="outliers(share=1e-4,deviation=0.03,channel=gyro_x)" ;;
  warm_up) hidden="warm_up(size=2e-3,time=60,channel=gyro_x)" ;;
  temperature) hidden="temperature(swing=2,period=90,coupling=5e-4,lag=10,channel=gyro_x)" ;;
  *)
    echo "$0: no effect '$effect'; there are ${known[*]}" >&2
    exit 2
    ;;
esac

rm -rf "$out/hidden" "$out/sealed.txt"
mkdir -p "$out"
echo "$hidden" > "$out/sealed.txt"
echo "Recording three replicates of an emulated ADIS16405 with a hidden effect (seed $seed) ..."
for replicate in 1 2 3; do
  "$imunoise" record "$out/hidden" --replicate "$replicate" --device "emulated device=adis16405 \
speed=0 length=2400 seed=$((seed + replicate)) 'model=gyro: WN(sigma2=9e-6) + RW(gamma2=1e-11)' 'effect=$hidden'" \
    > "$out/record-$replicate.txt" 2>&1
done

echo
echo "imunoise diagnose $out/hidden --channel emulated/imu/gyro_x --model \"WN + RW\" --auto"
echo
"$imunoise" diagnose "$out/hidden" --channel emulated/imu/gyro_x --model "WN + RW" --auto \
  --report "$out/diagnosis.html" 2> "$out/diagnose.txt"
echo
echo "The hidden effect: $(cat "$out/sealed.txt")"
echo "The page: file://$(realpath -m "$out")/diagnosis.html"
