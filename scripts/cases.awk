# The cases of GoogleTest's XML reports: seconds, outcome, name and reason, separated by tabs.
function attribute(name,    at) {
  at = index($0, " " name "=\"")
  if (at == 0) return ""
  at += length(name) + 3
  return substr($0, at, index(substr($0, at), "\"") - 1)
}
function finish() {
  if (open_case != "") print seconds "\t" outcome "\t" open_case "\t" reason
  open_case = ""
}
/<testcase / {
  finish()
  open_case = attribute("classname") "." attribute("name")
  seconds = attribute("time")
  outcome = attribute("result") == "skipped" ? "skipped" : attribute("status") == "run" ? "passed" : "left out"
  reason = ""
}
/<failure / { outcome = "failed" }
/<skipped / {
  outcome = "skipped"
  reason = attribute("message")
  sub(/^.*&#x0A;/, "", reason)
}
/<\/testsuites>/ { finish() }
