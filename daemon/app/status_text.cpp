#include "daemon/app/status_text.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace imunoise::app {
namespace {

// UTC, to the second.
std::string time_text(std::int64_t ns) {
  return fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", fmt::gmtime(ns / 1'000'000'000));
}

std::string what(const v1::CampaignStatus& status) {
  switch (status.phase()) {
    case v1::settling:
      return "settling";
    case v1::recording:
      return fmt::format("records replicate {} of {}{}", status.replicate(), status.replicates(),
                         status.attempt() == status.replicate()
                             ? ""
                             : fmt::format(", as replicate-{} on disk", status.attempt()));
    case v1::pausing:
      return "pauses";
    case v1::calibrating:
      return "calibrates";
    case v1::publishing:
      return "publishes";
    case v1::waiting:
      return "waits for the next recording";
    case v1::held_up:
      return "is blocked and will try again";
    case v1::finished:
      return "is finished";
    default:
      return "begins";
  }
}

// One line, whatever a driver said.
std::string one_line(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = ' ';
  }
  return text;
}

}  // namespace

std::string status_text(const v1::CampaignStatus& status) {
  std::string out = status.campaign() + ": " + what(status);
  if (!status.recording().empty() && status.phase() != v1::waiting) {
    out += " (" + status.recording() + ")";
  }
  if (status.until_ns() > 0) out += ", until " + time_text(status.until_ns());
  if (!status.reason().empty()) out += "; " + status.reason();
  return one_line(out);
}

}  // namespace imunoise::app
