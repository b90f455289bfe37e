# The Debian package under systemd: the confined service, its watchdog, its timer, its devices; upgrade, removal, purge.
# shellcheck source=tests/packaging/checks.sh
source "$SOURCE/tests/packaging/checks.sh"
export HOME=/root DEBIAN_FRONTEND=noninteractive
packages=$BUILD/hil/packages
part() { echo "== $1 ($(cut -d. -f1 /proc/uptime) s)"; }
service_is() { [[ $(systemctl show --property="$1" --value imunoised) == "$2" ]]; }

part "installs"
dpkg --install "$packages/1.deb" > /install.log 2>&1 || { cat /install.log && fail "dpkg --install"; }
[[ $(systemctl is-enabled imunoised) == enabled ]] || fail "the service is not enabled"
[[ $(systemctl is-failed imunoised) != failed ]] || fail "without campaigns it does not start, which is no failure"

part "starts, as its own user, without rights"
write_trial_campaign
systemctl start imunoised
until_true 60 "it records nothing" complete_replicates 1
pid=$(main_pid)
[[ $(stat --format=%U "/proc/$pid") == imunoise ]] || fail "it runs as $(stat --format=%U "/proc/$pid")"
grep -E '^CapEff:\s+0+$' "/proc/$pid/status" || fail "it has capabilities"
grep -E '^NoNewPrivs:\s+1$' "/proc/$pid/status" || fail "it may gain rights"
grep -E '^Seccomp:\s+2$' "/proc/$pid/status" || fail "it may call all of the kernel"

part "the page and the API answer through the socket"
api() { curl --silent --show-error --fail --compressed --unix-socket /run/imunoise/api.sock "http://localhost$1"; }
api / | grep -i -m1 -o '<!doctype html' || fail "no page"
api /v1/campaigns | grep -o -m1 '"trial"' | head -n 1 || fail "no campaigns"
api /healthz > /dev/null || fail "it is not well"
if runuser -u nobody -- curl --silent --unix-socket /run/imunoise/api.sock http://localhost/v1/campaigns; then
  fail "any user may speak to it"
fi

part "DeviceAllow: sensors, and nothing else, whatever the permissions of the nodes"
until_true 30 "the USB converter has no ttyUSB0: $(lsmod | grep -c usb) modules of USB" test -c /dev/ttyUSB0
usb=$(echo /dev/bus/usb/001/00*)
usb=${usb##* }
chmod 666 /dev/vda /dev/ttyUSB0 /dev/ttyS1 /dev/rtc0 "$usb"
cat > /probe.sh << 'PROBE'
for node in "$@"; do
  if message=$( (exec 3<> "$node") 2>&1); then echo "opens $node"; else echo "refuses $node: ${message##*: }"; fi
done
PROBE
runuser -u imunoise -- bash /probe.sh /dev/vda /dev/rtc0 /dev/ttyUSB0 /dev/ttyS1 "$usb" > /without.txt
mkdir -p /run/systemd/system/imunoise-campaign@probe.service.d
cat > /run/systemd/system/imunoise-campaign@probe.service.d/probe.conf << UNIT
[Service]
Type=oneshot
Restart=no
ExecStart=
ExecStart=/bin/bash /probe.sh /dev/vda /dev/rtc0 /dev/ttyUSB0 /dev/ttyS1 $usb
UNIT
touch /etc/imunoise/probe.toml
systemctl daemon-reload
systemctl start imunoise-campaign@probe.service || fail "the probe does not run"
journalctl --unit=imunoise-campaign@probe --output=cat --no-pager | grep -E '^(opens|refuses)' > /within.txt
rm -r /etc/imunoise/probe.toml /run/systemd/system/imunoise-campaign@probe.service.d
cat /within.txt
grep -c '^opens' /without.txt | grep -x 5 || { cat /without.txt && fail "without the confinement, all open"; }
for node in /dev/ttyUSB0 /dev/ttyS1 "$usb"; do grep -qx "opens $node" /within.txt || fail "it may not use $node"; done
for node in /dev/vda /dev/rtc0; do
  grep -qx "refuses $node: Operation not permitted" /within.txt || fail "it may use $node"
done

part "a campaign fires from its timer"
sed -e 's/trial/timed/' -e 's/10000/1/' /etc/imunoise/trial.toml > /etc/imunoise/timed.toml
printf '[schedule]\ncalendar = "*:*:0/20"\n[calibration]\nenabled = false\n' >> /etc/imunoise/timed.toml
mkdir -p /etc/systemd/system/imunoise-campaign@timed.timer.d
imunoised --print-timer /etc/imunoise/timed.toml > /etc/systemd/system/imunoise-campaign@timed.timer.d/calendar.conf
systemctl daemon-reload
systemctl enable --quiet --now imunoise-campaign@timed.timer
until_true 150 "the timer starts nothing" complete_replicates 1 timed
systemctl stop imunoise-campaign@timed.timer

part "a daemon that hangs is restarted by the watchdog"
pid=$(main_pid)
kill -STOP "$pid"
hung=$SECONDS
until_true 90 "the watchdog does nothing" service_is NRestarts 1
until_true 60 "it does not come back" service_is SubState running
echo "restarted $((SECONDS - hung)) s after it hung"
[[ $(main_pid) != "$pid" ]] || fail "the old program still runs"
journalctl --unit=imunoised --output=cat --no-pager | grep -m1 -i 'watchdog timeout' || fail "another reason"
before=$(cat /var/lib/imunoise/trial/*/replicate-*.json | grep -c '"complete"')
until_true 60 "it does not go on recording" complete_replicates $((before + 1))

part "an upgrade during a recording"
pid=$(main_pid)
before=$(cat /var/lib/imunoise/trial/*/replicate-*.json | grep -c '"complete"')
dpkg --install "$packages/2.deb" > /upgrade.log 2>&1 || { cat /upgrade.log && fail "upgrade"; }
[[ $(dpkg-query --show --showformat='${Version}' imunoise) == *-2 ]] || fail "the version"
until_true 60 "the new program does not run" service_is SubState running
[[ $(main_pid) != "$pid" ]] || fail "the old program still runs"
until_true 60 "it does not go on" complete_replicates $((before + 1))
journalctl _PID="$pid" --output=cat --no-pager | grep -x "trial: ended" || fail "the old program did not end in good order"

part "is removed; campaigns and recordings stay, and are sound"
pid=$(main_pid)
systemctl stop imunoised
for recording in /var/lib/imunoise/*/20*/; do
  imunoise verify "$recording" > /verify.txt || { cat /verify.txt && fail "$recording"; }
done
systemctl start imunoised
pid=$(main_pid)
((pid > 0)) || fail "it does not run before the removal"
dpkg --remove imunoise > /remove.log 2>&1
[[ ! -d /proc/$pid ]] || fail "it still runs"
if systemctl --quiet is-active imunoised; then fail "systemd thinks that it runs"; fi
[[ -e /etc/imunoise/trial.toml && ! -e /usr/bin/imunoise ]] || fail "campaigns are gone, or the program is not"
complete_replicates $((before + 1)) || fail "recordings are gone"

part "is purged: nothing is left but recordings and their user"
dpkg --purge imunoise > /purge.log 2>&1
grep "the recordings in /var/lib/imunoise are kept" /purge.log || fail "purge does not say so"
left=$(leftovers /host)
[[ -z $left ]] || fail "left behind: $left"
complete_replicates $((before + 1)) || fail "recordings are gone"
getent passwd imunoise
part "end"
