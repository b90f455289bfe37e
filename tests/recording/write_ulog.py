# Writes a ULog of PX4: write_ulog.py KIND FILE. 4000 samples at 800 Hz; gyro_x counts 0, 1, 2, ... in steps of its scale.
import struct
import sys

kind, path = sys.argv[1:3]
COUNT, EACH, PERIOD = 4000, 8, 1250  # samples, in a message, us

fifo = "uint64_t timestamp;uint64_t timestamp_sample;uint32_t device_id;float dt;float scale;uint8_t samples;" \
       "int16_t[32] x;int16_t[32] y;int16_t[32] z;uint8_t[3] _padding0;"
vector = "uint64_t timestamp;uint64_t timestamp_sample;uint32_t device_id;float x;float y;float z;float temperature;"
combined = "uint64_t timestamp;float[3] gyro_rad;uint32_t gyro_integral_dt;int32_t accelerometer_timestamp_relative;" \
           "float[3] accelerometer_m_s2;"
imu = "uint64_t timestamp;uint64_t timestamp_sample;float[3] delta_angle;float[3] delta_velocity;" \
      "uint32_t delta_angle_dt;uint32_t delta_velocity_dt;inner[2] more;"


def record(kind, content):
    return struct.pack("<Hc", len(content), kind.encode()) + content


def message(number, content):
    return record("D", struct.pack("<H", number) + content)


def fifo_message(number, begin, numbers, scale):
    last = 1_000_000 + (begin + EACH - 1) * PERIOD
    axes = b"".join(struct.pack("<32h", *(axis + [0] * 24)) for axis in numbers)
    return message(number, struct.pack("<QQIffB", last + 500, last, 7, PERIOD, scale, EACH) + axes)


def vector_message(number, i, numbers, late=0):
    at = 1_000_000 + i * PERIOD + late
    return message(number, struct.pack("<QQIffff", at + 400, at, 7, *numbers, 25.0))


out = b"ULog\x01\x12\x35\x01" + struct.pack("<Q", 1_000_000)
out += record("B", bytes(40))
out += record("F", b"inner:uint64_t timestamp;uint8_t a;float b;")
for name, text in (("sensor_gyro_fifo", fifo), ("sensor_accel_fifo", fifo), ("sensor_gyro", vector),
                   ("sensor_accel", vector), ("sensor_combined", combined), ("vehicle_imu", imu), ("other", "uint64_t timestamp;")):
    out += record("F", f"{name}:{text}".encode())
out += record("I", b"\x0fchar[5] sys_nameabcde")


def logged(number, name, instance=0):
    return record("A", struct.pack("<BH", instance, number) + name.encode())


out += logged(9, "other")
if "combined" in kind or kind == "fifo":
    out += logged(1, "sensor_combined")
if kind == "increments":
    out += logged(4, "vehicle_imu")
if kind == "fifo":
    out += logged(2, "sensor_gyro_fifo") + logged(3, "sensor_accel_fifo") + logged(5, "sensor_gyro_fifo", 1)
if kind in ("vectors", "rates"):
    out += logged(2, "sensor_gyro") + logged(3, "sensor_accel")
for i in range(COUNT):
    if kind == "fifo" and i % EACH == 0:
        count = [list(range(i + c, i + c + EACH)) for c in (0, 1, 2)]
        out += fifo_message(2, i, count, 0.5) + fifo_message(5, i, count, 0.25)
        out += fifo_message(3, i, [[0] * EACH, [0] * EACH, [20] * EACH], 0.5)
    if kind == "vectors":
        out += vector_message(2, i, [i / 2, i / 2 + 0.5, i / 2 + 1])
        if i != 1000:
            out += vector_message(3, i, [0, 0, 10], late=200)
    if kind == "rates":
        out += vector_message(2, i, [i / 2, i / 2 + 0.5, i / 2 + 1])
        if i % 2 == 0:
            out += vector_message(3, i, [0, 0, 10])
    if kind in ("fifo", "combined"):
        out += message(1, struct.pack("<Q3fIi3f", 1_000_000 + i * PERIOD, i / 2, i / 2 + 0.5, i / 2 + 1, PERIOD, 0, 0, 0, 10))
    if kind == "increments":
        angle = [(i / 2 + c / 2) * PERIOD * 1e-6 for c in range(3)]
        out += message(4, struct.pack("<QQ3f3fII26x", 0, 1_000_000 + i * PERIOD, *angle, 0, 0, 10 * PERIOD * 1e-6, PERIOD, PERIOD))
    if i == 500:
        out += record("O", struct.pack("<H", 12)) + message(9, bytes(8)) + record("L", b"6" + bytes(8) + b"a message")
open(path, "wb").write(out)
