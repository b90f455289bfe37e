# The recorder on a disk that loses power, returns errors, fills up and hangs, under ext4 and XFS. The kernel command line names the
# cycles by CYCLES. Called with a word by the test: what befalls the disk, or `restore`.
export mapped=/dev/mapper/faulty folder=/tmp/disk

# table FEATURES...: from now on the disk behaves so. Without a flush: what was not written is lost.
table() {
  dmsetup suspend --noflush --nolockfs faulty
  echo "0 $(blockdev --getsz /dev/vda) flakey /dev/vda 0 $*" | dmsetup load faulty
  dmsetup resume faulty
}

case ${1-all} in
  power_cut) table 0 1000 1 drop_writes ;;
  errors) table 0 1000 1 error_writes && sleep 1 ;;
  full) dd if=/dev/zero of=$folder/filler bs=1M status=none || sleep 1 ;;
  hang) dmsetup suspend --noflush --nolockfs faulty && sleep 3 && dmsetup resume faulty && sleep 1 ;;
  restore)
    umount $folder
    table 1000 0
    mount $mapped $folder
    rm -f $folder/filler
    ;;
  all)
    modprobe -d "$KERNEL" -a virtio_blk dm_mod dm-flakey ext4 xfs
    mkdir -p $folder
    for kind in ext4 xfs; do
      echo "0 $(blockdev --getsz /dev/vda) flakey /dev/vda 0 1000 0" | dmsetup create --noudevsync faulty
      dmsetup mknodes
      mkfs.$kind -q "$([[ $kind == xfs ]] && echo -f || echo -F)" $mapped
      mount $mapped $folder
      echo "on $kind:"
      IMUNOISE_DISK_FOLDER=$folder IMUNOISE_DISK_SCRIPT="bash $SCENARIO" DM_DISABLE_UDEV=1 "$BUILD/tests/test_faulty_disk"
      umount $folder
      dmsetup remove --noudevsync faulty
    done
    ;;
esac
