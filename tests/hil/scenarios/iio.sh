# The driver iio on devices of the kernel: a HID sensor hub by uhid, whose gyroscope and accelerometer have buffers, triggers and time stamps.
modprobe -d "$KERNEL" -a uhid hid_sensor_hub hid_sensor_gyro_3d hid_sensor_accel_3d
python3 "${SCENARIO%/*}/../hid_imu.py" > /tmp/imu.txt 2>&1 &
for _ in $(seq 60); do [[ $(cat /sys/bus/iio/devices/iio:device*/name 2> /dev/null | wc -l) == 2 ]] && break; sleep 0.5; done
cat /sys/bus/iio/devices/*/name /tmp/imu.txt

echo "several, and none chosen:"
"$BUILD/imunoise" record /tmp/none --device iio --duration 1 > /tmp/none.txt 2>&1 && exit 1
cat /tmp/none.txt
grep -q 'several IMUs' /tmp/none.txt
grep -q 'gyro_3d' /tmp/none.txt

"$BUILD/imunoise" record /tmp/rec --device 'iio device=gyro_3d' --device 'iio device=accel_3d' --duration 15 > /tmp/record.txt 2>&1 || { tr '\r' '\n' < /tmp/record.txt | tail; exit 1; }
tr '\r' '\n' < /tmp/record.txt | grep -v ' left'
"$BUILD/imunoise" verify /tmp/rec | tee /tmp/verify.txt
grep -q sound /tmp/verify.txt

# Numbers: X counts the samples, Y and Z follow it; no hole; the scales and units of the kernel.
python3 - << 'CHECK'
import glob
import h5py
import numpy as np

for kind, units, scale in (("gyro", "rad/s", np.pi / 180e3), ("acc", "m/s^2", 9.80665e-3)):
    rows = {axis: [] for axis in "xyz"}
    times, flags = [], []
    for name in sorted(glob.glob("/tmp/rec/replicate-1/*/*.h5")):
        stream = h5py.File(name)["imu"]
        if f"{kind}_x" not in stream:
            continue
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
    print(f"{kind}: {x.size} samples, {holes.size} holes, flags {sorted(set(flags.tolist()))}")
    assert (y == -x).all() and (z == 2 * x).all()
    assert (steps > 0).all() and (np.diff(times) > 0).all()
    assert x.size > 1200 and holes.size == 0, (x.size, x[holes], steps[holes])
    period = np.median(np.diff(times)) / 1e9
    assert abs(period - 0.01) < 0.003, period
CHECK
