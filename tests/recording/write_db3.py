"""Writes a ROS 2 bag with Python's sqlite3: write_db3.py FILE MESSAGES [FIRST] [packed] [split]. split: rates and
accelerations in two topics, as a RealSense has them. The messages are those of write_mcap.js."""
import sqlite3
import struct
import subprocess
import sys

path, messages = sys.argv[1], int(sys.argv[2])
first = int(sys.argv[3]) if len(sys.argv) > 3 else 0
packed = "packed" in sys.argv
split = "split" in sys.argv
bag = sqlite3.connect(path)
bag.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
            "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)")
bag.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
            "timestamp INTEGER NOT NULL, data BLOB NOT NULL)")
bag.execute("INSERT INTO topics VALUES(1, '/chatter', 'std_msgs/msg/String', 'cdr', '')")
bag.execute("INSERT INTO topics VALUES(2, '/imu', 'sensor_msgs/msg/Imu', 'cdr', '')")
bag.execute("INSERT INTO topics VALUES(3, '/accel', 'sensor_msgs/msg/Imu', 'cdr', '')")


def message(i, rates, accelerations, late=0):
    head = struct.pack("<iII", 1700000000 + i // 100, i % 100 * 10000000 + late, 9) + b"imu_link\0"
    head += bytes(-len(head) % 8)
    numbers = [0.0] * 13 + rates + [0.0] * 9 + accelerations + [0.0] * 9
    data = b"\0\1\0\0" + head + struct.pack("<37d", *numbers)
    if packed:
        return subprocess.run(["zstd", "-c", "-q"], input=data, stdout=subprocess.PIPE, check=True).stdout
    return data


for i in range(first, first + messages):
    rates, accelerations = [i, i + 0.25, i + 0.5], [9 + i, i / 2, -i]
    bag.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES(1, ?, ?)", (i, b"\0\1\0\0"))
    if split:
        bag.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES(3, ?, ?)", (i, message(i, [0, 0, 0], accelerations, 3000000)))
        accelerations = [0, 0, 0]
    bag.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES(2, ?, ?)", (i, message(i, rates, accelerations)))
bag.commit()
