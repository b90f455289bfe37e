"""Writes a ROS 1 bag with rosbag: write_bag.py FILE none|lz4|bz2 MESSAGES. The messages are those of write_mcap.js."""
import sys

import rosbag
import rospy
from sensor_msgs.msg import Imu
from std_msgs.msg import String

path, packing, messages = sys.argv[1], sys.argv[2], int(sys.argv[3])
with rosbag.Bag(path, "w", compression=packing, chunk_threshold=8000) as bag:
    for i in range(messages):
        imu = Imu()
        imu.header.seq = i
        imu.header.stamp = rospy.Time(1700000000 + i // 100, i % 100 * 10000000)
        imu.header.frame_id = "imu"
        imu.angular_velocity.x, imu.angular_velocity.y, imu.angular_velocity.z = i, i + 0.25, i + 0.5
        imu.linear_acceleration.x, imu.linear_acceleration.y, imu.linear_acceleration.z = 9 + i, i / 2, -i
        bag.write("/imu", imu, imu.header.stamp)
        bag.write("/chatter", String("text"), imu.header.stamp)
