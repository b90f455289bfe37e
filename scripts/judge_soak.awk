# Judges a soak: awk -v speed= -v injected= -v bad= -f judge_soak.awk replicates.tsv streams.tsv kills.txt memory.txt
# Exit status 1 when something was lost that no fault took, or memory grew.
FNR == 1 { ++file }
file == 1 { state[$1] = $2; started[$1] = $3; ended[$1] = $4; next }
file == 2 {
  key = $2
  rows[key] += $5; refused[key] += $6; lost[key] += $7; gaps[key] += $8
  if ($4 != $5 + $6) complain("replicate " $1 " " $2 " " $3 ": " $4 " received, " $5 " stored, " $6 " refused")
  if ($9 > 0) complain("replicate " $1 " " $2 " " $3 ": " $9 " rows twice")
  if ($10 > 0) complain("replicate " $1 " " $2 " " $3 ": " $10 " rows left in the journal")
  if ($2 != "adis16405" || $3 != "imu") next
  # The time of this device is emulated, so that only a fault can take a sample from it.
  if ($8 > injected) complain("replicate " $1 ": " $8 " gaps of " injected " faults")
  hours += ($5 + $7) / $11 / 3600
  accelerated[$1] = ($5 + $7) / $11 / speed  # seconds of ours that it recorded
  next
}
FILENAME ~ /kills/ { killed[++kills] = $2 / 1000; next }
FILENAME ~ /memory/ {
  if ($3 != life) { ++lives; life = $3; first[lives] = $1 }
  n = ++count[lives]; memory[lives, n] = $2 / 1024
  if ($2 / 1024 > most) most = $2 / 1024
}
function complain(text) { print "BAD: " text; bad = 1 }
function mean(life, from, to,   i, sum) {
  for (i = from; i <= to; ++i) sum += memory[life, i]
  return sum / (to - from + 1)
}
END {
  # Devices are opened a little before the replicate's start is noted.
  for (r in state) {
    if (state[r] != "complete") continue
    ahead = accelerated[r] - (ended[r] - started[r]) / 1e9
    if (ahead > lead) lead = ahead
  }
  for (r in state) {
    ++replicates[state[r]]
    if (state[r] == "open" && kills == 0) complain("replicate " r " is still open")
    from = started[r] / 1e9
    to = 0
    for (k = 1; k <= kills; ++k) if (killed[k] > from && (to == 0 || killed[k] < to)) to = killed[k]
    if (state[r] == "interrupted" && to > 0 && to - from < 1e5 && (ended[r] == 0 || ended[r] / 1e9 > to - 5)) {
      tail = to - from + lead - accelerated[r]
      ++tails
      if (tail > worst) worst = tail
    }
  }
  printf "%.1f hours of the accelerated device; %d replicates complete, %d interrupted; %d kills\n",
    hours, replicates["complete"], replicates["interrupted"] + replicates["open"], kills
  for (key in rows) {
    printf "%-10s %12d rows stored, %6d refused, %8d lost in %5d gaps\n", key, rows[key], refused[key], lost[key], gaps[key]
  }
  if (tails > 0) {
    printf "before a SIGKILL at most %.2f s were not on disk yet (of %d kills)\n", worst, tails
    if (worst > 3) complain("a kill cost more than three seconds")
  }
  for (l = 1; l <= lives; ++l) {
    if (count[l] < 120) continue
    early = mean(l, int(count[l] / 4), int(count[l] / 2))
    late = mean(l, int(count[l] * 3 / 4), count[l])
    printf "life %d, %d s: %.1f MB in its second quarter, %.1f MB in its last\n", l, count[l], early, late
    if (late > 1.05 * early + 1) complain("memory grew")
  }
  printf "most memory: %.1f MB in %d lives\n", most, lives
  print bad ? "FAILED" : "PASSED: nothing was lost but what faults took, and memory is flat"
  exit bad
}
