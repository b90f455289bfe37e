# SocketCAN: virtual interfaces, then two CAN controllers on one bus, whose bit rate is set.
load() { modprobe -d "$KERNEL" -a "$@"; }

load vcan can_raw
ip link add dev vcan0 type vcan
ip link set vcan0 mtu 72 up
"$BUILD/tests/test_drivers" --gtest_filter='VirtualCan.*' | tee /tmp/can.txt
! grep -q SKIPPED /tmp/can.txt

load kvaser_pci can_raw
for rate in 250000 1000000; do
  for name in can0 can1; do
    ip link set "$name" down
    ip link set "$name" txqueuelen 1000
    ip link set "$name" up type can bitrate "$rate" restart-ms 100
    ip -details link show "$name" | grep "bitrate $rate"
  done
  "$BUILD/imunoise" emulate --device can --at can0 --rate 100 --duration 120 > /tmp/emulate.txt 2>&1 &
  sleep 2
  "$BUILD/imunoise" record "/tmp/$rate" --device 'can interface=can1 preset=mti600 rate=100' --duration 5 || { cat /tmp/emulate.txt; exit 1; }
  "$BUILD/imunoise" verify "/tmp/$rate"
  kill %+ && wait %+ || true
done
