"""Writes the same scans as the package `rosbags` writes them, for ../rosbags.rs to read.

Usage: write.py FOLDER; makes little.cdr, big.cdr, ros1.bin, and the recordings plain/plain.mcap and
packed/packed.mcap. Nothing in them depends on the clock or on the machine.
"""

import sys
from pathlib import Path

import numpy as np
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

POINT_CLOUD = "sensor_msgs/msg/PointCloud2"
SECOND = 1_000_000_000
START = 1_700_000_000 * SECOND


def point_cloud(store, ros1, number):
    """An image of 3 x 2 pixels, the fifth of which is missing; fields out of order, with gaps."""
    types = store.types
    point = np.dtype({
        "names": ["intensity", "z", "x", "y"],
        "formats": ["<f4", "<f4", "<f8", "<i2"],
        "offsets": [0, 4, 8, 18],
        "itemsize": 24,
    })
    points = np.zeros(6, point)
    points["x"] = np.arange(6) / 10 + number
    points["y"] = np.arange(6) - 3
    points["z"] = [1, 2, 3, 4, np.nan, 6]
    rows = np.zeros((2, 3 * point.itemsize + 8), np.uint8)
    rows[:, :-8] = points.view(np.uint8).reshape(2, -1)
    rows[:, -8:] = 255
    kinds = {"<f4": 7, "<f8": 8, "<i2": 3}
    fields = [
        types["sensor_msgs/msg/PointField"](name, point.fields[name][1], kinds[kind], 1)
        for name, kind in zip(point.names, ["<f4", "<f4", "<f8", "<i2"])
    ]
    stamp = types["builtin_interfaces/msg/Time"](sec=1_700_000_000, nanosec=250_000_000 + number)
    arguments = {"seq": number} if ros1 else {}
    header = types["std_msgs/msg/Header"](stamp=stamp, frame_id="lidar_top", **arguments)
    return types[POINT_CLOUD](
        header=header, height=2, width=3, fields=fields, is_bigendian=False,
        point_step=point.itemsize, row_step=rows.shape[1], data=rows.reshape(-1), is_dense=False,
    )


def main(folder):
    ros2, ros1 = get_typestore(Stores.ROS2_HUMBLE), get_typestore(Stores.ROS1_NOETIC)
    message = point_cloud(ros2, False, 0)
    (folder / "little.cdr").write_bytes(ros2.serialize_cdr(message, POINT_CLOUD))
    (folder / "big.cdr").write_bytes(ros2.serialize_cdr(message, POINT_CLOUD, little_endian=False))
    (folder / "ros1.bin").write_bytes(ros1.serialize_ros1(point_cloud(ros1, True, 0), POINT_CLOUD))
    for name in ["plain", "packed"]:
        bag = Writer(folder / name, version=9, storage_plugin=StoragePlugin.MCAP)
        if name == "packed":
            bag.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
        with bag:
            text = bag.add_connection("/note", "std_msgs/msg/String", typestore=ros2)
            points = bag.add_connection("/lidar/points", POINT_CLOUD, typestore=ros2)
            note = ros2.types["std_msgs/msg/String"]("begin")
            bag.write(text, START, ros2.serialize_cdr(note, "std_msgs/msg/String"))
            for number in range(5):
                scan = ros2.serialize_cdr(point_cloud(ros2, False, number), POINT_CLOUD)
                bag.write(points, START + SECOND // 4 + number * SECOND // 10, scan)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
