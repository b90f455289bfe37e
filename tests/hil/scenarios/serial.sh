# A ttyUSB of the kernel: QEMU's USB serial converter, on whose other end an emulated MTi-G speaks. The driver finds the baud rate, and the
# recording goes on when the converter is unplugged for some seconds. The machine's owner reads the lines in capitals and does what they say.
modprobe -d "$KERNEL" -a uhci_hcd usbserial ftdi_sio
for _ in $(seq 60); do [[ -e /dev/ttyUSB0 ]] && break; sleep 0.5; done
"$BUILD/imunoise" record /tmp/rec --device 'xsens port=/dev/ttyUSB0' --duration 30 > /tmp/record.txt 2>&1 &
sleep 10
echo "UNPLUG THE SENSOR"
for _ in $(seq 60); do [[ ! -e /dev/ttyUSB0 ]] && break; sleep 0.2; done
[[ ! -e /dev/ttyUSB0 ]]
sleep 2
echo "PLUG THE SENSOR IN"
wait %1 || { tr '\r' '\n' < /tmp/record.txt | tail; exit 1; }
tr '\r' '\n' < /tmp/record.txt | grep -v ' left'
"$BUILD/imunoise" verify /tmp/rec | tee /tmp/verify.txt
grep -q 'sound' /tmp/verify.txt
