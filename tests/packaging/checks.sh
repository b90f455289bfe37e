# shellcheck shell=bash
# What tests of the installed package ask; sourced. They run on a machine that systemd booted.

fail() {
  echo "FAILED: $1"
  journalctl --no-pager --lines=40 || true
  exit 1
}
# until_true SECONDS WHAT COMMAND...
until_true() {
  local seconds=$1 what=$2
  shift 2
  for ((i = 0; i < seconds * 5; ++i)); do
    if "$@"; then return 0; fi
    sleep 0.2
  done
  fail "$what"
}
# complete_replicates COUNT [CAMPAIGN]: at least so many.
complete_replicates() {
  local count
  count=$(cat /var/lib/imunoise/"${2-trial}"/*/replicate-*.json 2> /dev/null | grep -c '"complete"' || true)
  ((count >= $1))
}
main_pid() { systemctl show --property=MainPID --value imunoised; }
# What is left of the package, beside recordings. FOLDERS... are not looked into.
leftovers() {
  local others=()
  for folder in "$@"; do others+=(-o -path "$folder"); done
  find / -xdev \( -path /proc -o -path /sys -o -path /var/lib/imunoise "${others[@]}" \) -prune -o \
    -name '*imunoise*' -print
}
# Campaign "trial": an emulated MTi, a second a replicate, for hours.
write_trial_campaign() {
  cat > /etc/imunoise/trial.toml << 'CAMPAIGN'
name = "trial"
folder = "trial"
length = "1 s"
replicates = 10000
reserve = "1 MB"
[[device]]
driver = "emulated"
options.device = "xsens"
options.seed = 7
CAMPAIGN
}
