"""imu.bag: ten minutes of sensor_msgs/Imu at 100 Hz, white noise and random walks, gravity along z. Exit status 77: no rosbag."""

import sys

try:
    import numpy as np
    import rosbag
    import rospy
    from sensor_msgs.msg import Imu
except ImportError as missing:
    print(f"skipped: {missing} (python3-rosbag, python3-sensor-msgs)")
    sys.exit(77)

random = np.random.default_rng(1)
count = 60_000


def noise(white: float, walk: float) -> np.ndarray:
    return random.normal(0, white, (count, 3)) + np.cumsum(random.normal(0, walk, (count, 3)), axis=0)


gyro, acc = noise(5e-4, 2e-7), noise(2e-2, 3e-6) + [0, 0, 9.81]
with rosbag.Bag("imu.bag", "w") as bag:
    for k in range(count):
        message = Imu()
        message.header.stamp = rospy.Time.from_sec(1.7e9 + k / 100)
        message.angular_velocity.x, message.angular_velocity.y, message.angular_velocity.z = gyro[k]
        message.linear_acceleration.x, message.linear_acceleration.y, message.linear_acceleration.z = acc[k]
        bag.write("/imu/data", message, message.header.stamp)
