#!/bin/busybox sh
# The first program of the virtual machine. It shows the files of the system that started it, with a layer of memory over them, and runs
# the scenario; or, where the command line names a DISK with a Debian, it hands the machine over to that one's systemd, whose last service
# is the scenario.
/bin/busybox --install -s /bin
mount -t proc proc /proc
mount -t sysfs sys /sys
mount -t devtmpfs dev /dev
while read -r name; do insmod "/modules/$name"; done < /modules/order
mount -t 9p -o trans=virtio,version=9p2000.L,ro,msize=512000,cache=loose host /lower
if [ -n "$DISK" ]; then
  mount -t ext4 "$DISK" /root
  mkdir -p /root/host /root/lib/modules
  mount --move /lower /root/host
  mount --bind "/root/host$KERNEL/lib/modules" /root/lib/modules
  cat > /root/etc/systemd/system/scenario.service << UNIT
[Unit]
After=multi-user.target
SuccessAction=poweroff-force
FailureAction=poweroff-force
[Service]
Type=oneshot
Environment=BUILD=/host$BUILD SOURCE=/host$SOURCE
ExecStart=/bin/bash -euo pipefail -c '. /host$SCENARIO; echo "SCENARIO PASSED"'
StandardOutput=tty
StandardError=inherit
TTYPath=/dev/ttyS0
TimeoutStartSec=infinity
UNIT
  mkdir -p /root/etc/systemd/system/graphical.target.wants
  ln -s ../scenario.service /root/etc/systemd/system/graphical.target.wants/
  for name in proc sys dev; do mount --move "/$name" "/root/$name"; done
  exec switch_root /root /sbin/init
fi
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
