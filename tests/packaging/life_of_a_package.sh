#!/usr/bin/env bash
# Runs inside a container that systemd booted: installs /packages/1.deb, starts the service, upgrades to
# /packages/2.deb, removes and purges it. What must hold is checked on the way; the first thing that does not ends it.
set -euo pipefail
export DEBIAN_FRONTEND=noninteractive PS4='> '

# shellcheck source=tests/packaging/checks.sh
source /packages/checks.sh

echo "== installs, with nothing but Debian's packages"
apt-get update -qq
apt-get install -y -qq --no-install-recommends /packages/1.deb > /install.log 2>&1 ||
  { cat /install.log && fail "apt-get install"; }
if grep -i -E 'warning|error|failed' /install.log | grep -i imunoise; then fail "a maintainer script complains"; fi
imunoise --version
imunoised --check-config /usr/share/doc/imunoise/examples
for page in man1/imunoise.1 man1/imunoise-batch-run.1 man5/imunoise-campaign.5 man8/imunoised.8; do
  gzip -t "/usr/share/man/$page.gz"
done
bash -n /usr/share/bash-completion/completions/imunoise
bash -n /usr/share/bash-completion/completions/imunoised
test -s /usr/share/zsh/vendor-completions/_imunoise
[[ $(imunoise drivers | grep -c -E '^(adis16405|can|emulated|iio|replay|text|wire|xsens)\b') == 8 ]] ||
  { imunoise drivers && fail "a driver is missing"; }
[[ $(stat --format='%U %G %a' /var/lib/imunoise) == "imunoise imunoise 750" ]] || fail "/var/lib/imunoise"
[[ -d /etc/imunoise ]] || fail "/etc/imunoise"
[[ $(systemctl is-enabled imunoised) == enabled ]] || fail "the service is not enabled"
[[ $(systemctl is-failed imunoised) != failed ]] || fail "without campaigns it does not start, which is no failure"

echo "== starts, and records"
write_trial_campaign
systemctl start imunoised
until_true 60 "it records nothing" complete_replicates 2
before=$(main_pid)

echo "== upgrades, and goes on recording"
apt-get install -y -qq --no-install-recommends /packages/2.deb > /upgrade.log 2>&1 ||
  { cat /upgrade.log && fail "upgrade"; }
[[ $(dpkg-query --show --showformat='${Version}' imunoise) == *-2 ]] || fail "the version"
systemctl is-active imunoised
[[ $(main_pid) != "$before" ]] || fail "the old program still runs"
count=$(cat /var/lib/imunoise/trial/*/replicate-*.json | grep -c '"complete"')
until_true 60 "it does not go on" complete_replicates $((count + 2))

echo "== what the administrator decided is kept"
systemctl disable --quiet imunoised
apt-get install -y -qq --reinstall /packages/2.deb > /dev/null 2>&1
[[ $(systemctl is-enabled imunoised || true) == disabled ]] || fail "it was enabled again"
systemctl enable --quiet imunoised

echo "== is removed: the service stops in good order, campaigns and recordings stay"
pid=$(main_pid)
((pid > 0)) || fail "it does not run before the removal"
apt-get remove -y -qq imunoise > /dev/null 2>&1
[[ ! -d /proc/$pid ]] || fail "it still runs"
if systemctl --quiet is-active imunoised; then fail "systemd thinks that it runs"; fi
[[ -e /etc/imunoise/trial.toml ]] || fail "campaigns are gone"
complete_replicates 4 || fail "recordings are gone"
if [[ -e /usr/bin/imunoise ]]; then fail "the program is still there"; fi

echo "== recordings made under it are sound"
apt-get install -y -qq --no-install-recommends /packages/2.deb > /dev/null 2>&1
systemctl stop imunoised
for recording in /var/lib/imunoise/trial/*/; do imunoise verify "$recording" > /dev/null || fail "$recording"; done

echo "== is purged: nothing is left but recordings, and their user"
apt-get purge -y -qq imunoise > /purge.log 2>&1
grep "the recordings in /var/lib/imunoise are kept" /purge.log || fail "purge does not say so"
left=$(leftovers /packages)
[[ -z $left ]] || fail "left behind: $left"
complete_replicates 4 || fail "recordings are gone"
getent passwd imunoise

echo "== without recordings, nothing at all"
rm -rf /var/lib/imunoise
apt-get install -y -qq --no-install-recommends /packages/1.deb > /dev/null 2>&1
apt-get purge -y -qq imunoise > /dev/null 2>&1
[[ ! -e /var/lib/imunoise ]] || fail "the empty folder is left"
echo "PASSED"
touch /trial.passed
