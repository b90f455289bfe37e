# The driver iio on devices of the kernel: a HID sensor hub by uhid, whose gyroscope and accelerometer have buffers, triggers and time stamps. It is
# unplugged and plugged in while it is recorded.
modprobe -d "$KERNEL" -a uhid hid_sensor_hub hid_sensor_gyro_3d hid_sensor_accel_3d
python3 "${SCENARIO%/*}/../hid_imu.py" /tmp/unplugged > /tmp/imu.txt 2>&1 &
devices() { cat /sys/bus/iio/devices/iio:device*/name 2> /dev/null | wc -l; }
until_devices() {
  for _ in $(seq 60); do [[ $(devices) == "$1" ]] && return; sleep 0.5; done
  echo "$(devices) devices instead of $1"
  return 1
}
until_devices 2
cat /sys/bus/iio/devices/*/name /tmp/imu.txt

echo "several, and none chosen:"
"$BUILD/imunoise" record /tmp/none --device iio --duration 1 > /tmp/none.txt 2>&1 && exit 1
cat /tmp/none.txt
grep -q 'several IMUs' /tmp/none.txt
grep -q 'gyro_3d' /tmp/none.txt

# record FOLDER SECONDS: both; what it said is shown.
record() {
  "$BUILD/imunoise" record "$1" --device 'iio device=gyro_3d' --device 'iio device=accel_3d' --duration "$2" > "$1.txt" 2>&1 ||
    { tr '\r' '\n' < "$1.txt" | tail; return 1; }
  tr '\r' '\n' < "$1.txt" | grep -v ' left'
  "$BUILD/imunoise" verify "$1" > "$1.verify.txt" || { cat "$1.verify.txt"; return 1; }
  cat "$1.verify.txt"
  grep -q sound "$1.verify.txt"
}

# Numbers: X counts the samples, Y and Z follow it; the scales and units of the kernel. check FOLDER HOLES: sent = stored + reported missing.
check() {
  "$BUILD/imunoise" verify "$1" --json > "$1.verify.json"
  python3 - "$@" << 'CHECK'
import glob
import json
import sys

import h5py
import numpy as np

folder, expected = sys.argv[1], int(sys.argv[2])
report = json.load(open(folder + ".verify.json"))
for kind, units, scale in (("gyro", "rad/s", np.pi / 180e3), ("acc", "m/s^2", 9.80665e-3)):
    rows = {axis: [] for axis in "xyz"}
    times, flags, device = [], [], None
    for name in sorted(glob.glob(folder + "/replicate-1/*/*.h5")):
        stream = h5py.File(name)["imu"]
        if f"{kind}_x" not in stream:
            continue
        device = name.split("/")[-2]
        for axis in "xyz":
            channel = stream[f"{kind}_{axis}"]
            rows[axis].append(channel[:])
            assert channel.attrs["units"].decode() == units, channel.attrs["units"]
            assert abs(channel.attrs["scale_factor"] / scale - 1) < 1e-4, channel.attrs["scale_factor"]
        times.append(stream["host_time"][:])
        flags.append(stream["flags"][:])
    x, y, z = (np.concatenate(rows[axis]).astype(np.int64) for axis in "xyz")
    times, flags = np.concatenate(times), np.concatenate(flags)
    steps, holes = np.diff(x), np.flatnonzero(np.diff(x) != 1)
    gaps = next(one for one in report["streams"] if one["device"] == device).get("gaps", [])
    told = {int(gap["after_sample"]): int(gap.get("lost", 0)) for gap in gaps}
    # The last sample before a hole may carry a late time: part of the hole is then told before it.
    missing = sum(lost for after, lost in told.items() if (np.abs(holes - after) <= 3).any())
    sent = x[-1] - x[0] + 1
    print(f"{kind}: {sent} samples sent from the first stored to the last, {x.size} stored, {missing} reported missing in {holes.size} holes")
    assert (y == -x).all() and (z == 2 * x).all()
    assert (steps > 0).all() and (np.diff(times) > 0).all()
    assert holes.size == expected, (x[holes], steps[holes])
    assert (flags[holes + 1] != 0).all(), flags[holes + 1]  # the hole is marked
    period = np.median(np.diff(times)) / 1e9
    assert abs(period - 0.01) < 0.003, period
    # Only time stamps count what is missing, to a sample a hole. Elsewhere those of a busy machine may come late for good, which looks the same.
    assert abs(sent - x.size - missing) <= holes.size, (sent, x.size, missing)
    assert x.size > 1200
CHECK
}

record /tmp/rec 15
check /tmp/rec 0

echo "unplugged for some seconds:"
record /tmp/away 45 &
sleep 15
touch /tmp/unplugged
until_devices 0
sleep 2
rm /tmp/unplugged
until_devices 2
wait %2
check /tmp/away 1
grep -i 'is back' /tmp/away.txt
