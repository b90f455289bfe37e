# A table of the fitted parameters of `imunoise fit --json` beside the true ones.
#   awk -v truth="WN(sigma2=1e-7) + RW(gamma2=1e-15)" -f fit_against_truth.awk fit.json
# Reads the JSON as imunoise prints it: one "key": value a line. Each process stands once in the model.

function short(number) { return number == "" ? "-" : sprintf("%.5g", number) }

function finish() {
  if (parameter != "") {
    known = (term " " parameter) in true_value
    if (!known) missing = missing " " term "." parameter
    real = true_value[term " " parameter] + 0
    # An end that is absent is not known: the interval is open there.
    inside = (lower == "" || lower + 0 <= real) && (upper == "" || real <= upper + 0)
    judged = lower == "" && upper == "" ? "no interval" : inside ? "covered" : "NOT covered"
    printf "  %-5s %-8s %12.5g %12.5g   [%s, %s]   %s\n", term, parameter, real, value, short(lower),
           short(upper), judged
    rows++
  }
  parameter = value = lower = upper = ""
}

BEGIN {
  count = split(truth, terms, / *\+ +/)
  for (i = 1; i <= count; ++i) {
    name = terms[i]
    sub(/\(.*/, "", name)
    inside_brackets = terms[i]
    gsub(/^[^(]*\(|\).*$/, "", inside_brackets)
    pairs = split(inside_brackets, list, / *, */)
    for (k = 1; k <= pairs; ++k) {
      split(list[k], pair, "=")
      true_value[name " " pair[1]] = pair[2]
      expected++
    }
  }
  printf "  %-5s %-8s %12s %12s   %s\n", "term", "", "true", "fitted", "95 % interval"
}

{
  if (!match($0, /"[a-z_0-9]+": /)) next
  key = substr($0, RSTART + 1, RLENGTH - 4)
  text = substr($0, RSTART + RLENGTH)
  sub(/,$/, "", text)
  gsub(/"/, "", text)
  if (key == "terms") {
    part = "term"
  } else if (key == "budget") {
    finish()
    part = ""
  } else if (part == "") {
    next
  } else if (key == "parameters") {
    part = "parameters"
  } else if (key == "coefficients" || key == "variance") {
    finish()
    part = "term"
  } else if (key == "name" && part == "term") {
    term = text
  } else if (key == "name") {
    finish()
    parameter = text
  } else if (part == "parameters" && key == "value") {
    value = text
  } else if (part == "parameters" && key == "lower") {
    lower = text
  } else if (part == "parameters" && key == "upper") {
    upper = text
  }
}

END {
  if (missing != "" || rows != expected) {
    print "fit_against_truth: the fit and the truth have different parameters" (missing == "" ? "" : ":" missing) > "/dev/stderr"
    exit 1
  }
}
