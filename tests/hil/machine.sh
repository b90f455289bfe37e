# A virtual machine with Debian's kernel, without KVM and without root: its files are those of this system, read only; what it writes
# lies in its memory. Sourced by run.sh.

# kernel FOLDER: Debian's newest kernel, unpacked there once. Sets `image` and `version`.
kernel() {
  local folder=$1 package
  if ! compgen -G "$folder/boot/vmlinuz-*" > /dev/null; then
    package=$(apt-cache depends linux-image-amd64 | awk '/Depends: linux-image/ {print $2; exit}')
    mkdir -p "$folder"
    (cd "$folder" && apt-get download "$package" && dpkg-deb -x "$package"_*.deb . && rm "$package"_*.deb)
  fi
  image=$(echo "$folder"/boot/vmlinuz-*)
  version=${image##*/vmlinuz-}
  [[ -e $folder/lib/modules/$version/modules.dep ]] || /sbin/depmod -b "$folder" "$version"
}

# first_files KERNEL_FOLDER OUT: the archive that the kernel starts from: busybox, guest_init.sh, and what it takes to see this system's files.
first_files() {
  local folder=$1 out=$2 root name file
  root=$(mktemp -d)
  mkdir -p "$root"/{bin,proc,sys,dev,lower,upper,root,modules}
  cp /bin/busybox "$root/bin/busybox"
  cp "$here/guest_init.sh" "$root/init"
  chmod +x "$root/init"
  for name in virtio_pci 9pnet_virtio 9p overlay virtio_blk ext4; do
    /sbin/modprobe -d "$folder" -S "$version" --show-depends "$name"
  done | awk '$1 == "insmod" && !seen[$2]++ {print $2}' | while read -r file; do
    cp "$file" "$root/modules/"
    basename "$file" >> "$root/modules/order"
  done
  (cd "$root" && find . | cpio --create --format=newc --quiet) > "$out"
  rm -r "$root"
}

# debian DISK PACKAGE...: an image of a disk with a small Debian and these packages, made once for a list of packages.
debian() {
  local disk=$1 list
  shift
  list=$(IFS=,; echo "$*")
  [[ -e $disk && $(cat "$disk.list" 2> /dev/null) == "$list" ]] && return
  mmdebstrap --quiet --variant=minbase --format=ext2 --include="$list" --dpkgopt='path-exclude=/usr/share/locale/*' bookworm "$disk"
  truncate --size=+500M "$disk"
  /sbin/e2fsck -fy "$disk" > /dev/null 2>&1 || (($? == 1))
  /sbin/resize2fs "$disk" > /dev/null 2>&1
  echo "$list" > "$disk.list"
}

# boot SCENARIO SECONDS [QEMU ARGUMENT...]: runs scenarios/SCENARIO.sh as root in a new machine. `more` holds further words of the kernel's
# command line. Fails unless the scenario says that it passed.
boot() {
  local scenario=$1 seconds=$2 log=$scratch/$1.log
  shift 2
  timeout "$seconds" qemu-system-x86_64 -machine pc -accel tcg,thread=multi -cpu qemu64 -smp 2 -m 1024 \
    -nodefaults -no-user-config -display none -serial stdio -no-reboot \
    -kernel "$image" -initrd "$scratch/first.cpio" \
    -append "console=ttyS0 panic=-1 quiet mitigations=off no_timer_check nokaslr SCENARIO=$here/scenarios/$scenario.sh BUILD=$build SOURCE=$source KERNEL=$kernels ${more-}" \
    -virtfs local,path=/,mount_tag=host,security_model=none,readonly=on,multidevs=remap \
    "$@" < /dev/null 2>&1 | tee "$log" || true
  tr -d '\r' < "$log" | grep -qx "SCENARIO PASSED"
}
