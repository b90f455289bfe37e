#include "daemon/live/trouble.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

namespace imunoise::live {
namespace {

// The same text whenever it is asked for: the two clocks are compared once.
std::time_t time_of_day(Steady::time_point time) {
  static const auto kOffset =
      std::chrono::system_clock::now().time_since_epoch() - Steady::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::seconds>(time.time_since_epoch() + kOffset)
      .count();
}

}  // namespace

std::string sentence(const Trouble& trouble) {
  return fmt::format("{} (since {:%Y-%m-%d %H:%M:%S} UTC)", trouble.what,
                     fmt::gmtime(time_of_day(trouble.since)));
}

std::optional<Trouble> trouble_of(const recording::DiskCall& call, Steady::time_point now) {
  if (now - call.since < kHangsAfter) return std::nullopt;
  return Trouble{fmt::format("the disk hangs: {} of {} does not return; check the disk and the "
                             "kernel's log (dmesg)",
                             call.what, call.path.string()),
                 call.since, true};
}

std::optional<Trouble> trouble_of(const std::string& device, const recording::DeviceDisk& disk,
                                  Steady::time_point now) {
  if (disk.call) {
    if (auto found = trouble_of(*disk.call, now)) return found;
  }
  if (!disk.trouble) return std::nullopt;
  return Trouble{fmt::format("device {}: the disk fails: {}", device, disk.trouble->error.message),
                 disk.trouble->since, false};
}

}  // namespace imunoise::live
