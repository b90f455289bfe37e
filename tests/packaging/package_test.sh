#!/usr/bin/env bash
# Builds two revisions of the package, boots an empty Debian 12 in a container, and lets life_of_a_package.sh
# install, start, upgrade, remove and purge them there. Exit status 77: it cannot be tried here, and why.
#
#   bash tests/packaging/package_test.sh [FIRST.deb SECOND.deb]     packages made before, instead of built ones
set -euo pipefail
first=${1:+$(realpath "$1")}
second=${2:+$(realpath "$2")}
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
cd "$here/../.."

skip() {
  echo "SKIPPED: $1"
  exit 77
}
((EUID == 0)) || skip "only root makes and boots a container"
for program in debootstrap systemd-nspawn cpack dpkg-deb lintian; do
  command -v "$program" > /dev/null || skip "$program is not here (scripts/install_packages.sh slow)"
done

folder=$(mktemp -d /var/tmp/imunoise-package-XXXXXX)
trap 'rm -rf "$folder"' EXIT
root=$folder/root

debootstrap --variant=minbase --include=systemd,systemd-sysv,dbus,udev,init-system-helpers bookworm "$root" \
  > "$folder/debootstrap.log" 2>&1 || skip "debootstrap failed: $(tail -n 1 "$folder/debootstrap.log")"

mkdir "$root/packages"
cp "$here/checks.sh" "$root/packages/"
if [[ -n $second ]]; then
  cp "$first" "$root/packages/1.deb"
  cp "$second" "$root/packages/2.deb"
else
  for revision in 1 2; do
    bash scripts/package.sh "$revision"
    cp "build/package/package/"*"-${revision}_"*.deb "$root/packages/$revision.deb"
  done
fi

# The trial is a service of the container, which it switches off when it is over.
cp "$here/life_of_a_package.sh" "$root/life_of_a_package.sh"
cat > "$root/etc/systemd/system/trial.service" << 'UNIT'
[Unit]
After=multi-user.target
SuccessAction=poweroff
FailureAction=poweroff
[Service]
Type=oneshot
ExecStart=/bin/bash /life_of_a_package.sh
StandardOutput=file:/trial.log
StandardError=inherit
TimeoutStartSec=1200
[Install]
WantedBy=graphical.target
UNIT
mkdir -p "$root/etc/systemd/system/graphical.target.wants"
ln -s ../trial.service "$root/etc/systemd/system/graphical.target.wants/trial.service"

timeout 1500 systemd-nspawn --directory="$root" --boot --register=no --keep-unit --quiet \
  > "$folder/boot.log" 2>&1 < /dev/null || true
if [[ ! -e $root/trial.log ]]; then
  tail -n 20 "$folder/boot.log"
  skip "the container does not boot"
fi
cat "$root/trial.log"
[[ -e $root/trial.passed ]]
