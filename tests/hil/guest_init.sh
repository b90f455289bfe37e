#!/bin/busybox sh
# The first program of the virtual machine: the files of the system that started it, with a layer of memory over them.
/bin/busybox --install -s /bin
mount -t proc proc /proc
mount -t sysfs sys /sys
mount -t devtmpfs dev /dev
while read -r name; do insmod "/modules/$name"; done < /modules/order
mount -t 9p -o trans=virtio,version=9p2000.L,ro,msize=512000,cache=loose host /lower
mount -t tmpfs memory /upper
mkdir /upper/data /upper/work
mount -t overlay -o lowerdir=/lower,upperdir=/upper/data,workdir=/upper/work over /root
for name in proc sys dev; do mount --move "/$name" "/root/$name"; done
mount -t tmpfs memory /root/tmp
mount -t tmpfs memory /root/run
mkdir -p /root/dev/pts /root/dev/shm
mount -t devpts devpts /root/dev/pts
mount -t tmpfs memory /root/dev/shm
export PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/tmp
ip link set lo up
chroot /root /bin/bash -euo pipefail "$SCENARIO" && echo "SCENARIO PASSED"
poweroff -f
