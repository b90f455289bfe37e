#!/usr/bin/python3
"""An emulated HID sensor hub with a gyroscope and an accelerometer (HID Usage Tables, Sensors page), by /dev/uhid: the kernel makes IIO devices
of them. Both sample at 100 Hz; the X axes count samples, Y and Z are -1 and 2 times as much. It is unplugged while a file of the name that it was
given exists; the samples are counted on meanwhile.
"""

import os
import select
import struct
import sys
import time

CREATE2, DESTROY, OPEN, CLOSE, GET_REPORT, GET_REPLY, INPUT2, SET_REPORT, SET_REPLY = 11, 1, 4, 5, 9, 10, 12, 13, 14
INTERVAL_MS = 10
AXES = {1: (0x76, 0x0457), 2: (0x73, 0x0453)}  # report: usage of the sensor, of its X axis


def short(usage):
    return bytes([0x0A, usage & 0xFF, usage >> 8])


def sensor(report, usage, first_axis):
    number = bytes.fromhex("7520 9501")  # 32 bits, one of them
    interval = short(0x030E) + bytes.fromhex("1500 27ffffff7f") + number + bytes.fromhex("5500 b102")
    byte = bytes.fromhex("1500 2505 7508 9501 b102")
    state = short(0x0316) + byte + short(0x0319) + byte  # of reports, of power
    axes = bytes.fromhex("1700000080 27ffffff7f") + number + bytes.fromhex("550d")  # thousandths of the unit
    for axis in range(3):
        axes += short(first_axis + axis) + bytes.fromhex("8102")
    return bytes([0x85, report, 0x05, 0x20, 0x09, usage, 0xA1, 0x00]) + interval + state + axes + b"\xc0"


def plug():
    descriptor = bytes.fromhex("0520 0901 a101")
    for report, (usage, axis) in AXES.items():
        descriptor += sensor(report, usage, axis)
    descriptor += b"\xc0"
    device = os.open("/dev/uhid", os.O_RDWR)
    os.write(device, struct.pack("<I128s64s64sHHIIII4096s", CREATE2, b"emulated sensor hub", b"", b"HIL1", len(descriptor), 3, 0x1234, 0x5678, 0, 0,
                                 descriptor))
    return device


def answer(device):
    event = os.read(device, 4380)
    kind = struct.unpack_from("<I", event)[0]
    if kind == GET_REPORT:
        identity, report = struct.unpack_from("<IB", event, 4)
        data = bytes([report]) + struct.pack("<IBB", INTERVAL_MS, 1, 1)
        os.write(device, struct.pack("<IIHH4096s", GET_REPLY, identity, 0, len(data), data))
    elif kind == SET_REPORT:
        os.write(device, struct.pack("<IIH", SET_REPLY, struct.unpack_from("<I", event, 4)[0], 0))


unplugged = sys.argv[1]
device, count, due = plug(), 0, time.monotonic()
while True:
    left = due - time.monotonic()
    if left > 0:
        if select.select([device] if device else [], [], [], left)[0]:
            answer(device)
        continue
    due += INTERVAL_MS / 1000
    count += 1
    if device and os.path.exists(unplugged):
        os.write(device, struct.pack("<I", DESTROY))
        os.close(device)
        device = None
    elif not device and not os.path.exists(unplugged):
        device = plug()
    if not device:
        continue
    for report in AXES:
        data = bytes([report]) + struct.pack("<iii", count, -count, 2 * count)
        os.write(device, struct.pack("<IH4096s", INPUT2, len(data), data))
