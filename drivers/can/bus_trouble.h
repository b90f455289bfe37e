#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "drivers/can/codec/frame.h"

namespace imunoise::can {

/// Counts error frames and lost frames, and words it for people; not more often than every ten
/// seconds.
class BusTrouble {
 public:
  /// True where the controller went off the bus.
  bool add_error(const drivers::CanFrame& frame);
  void add_lost(std::uint64_t frames) { lost_ += frames; }

  /// What happened since the last report; nothing where nothing did, or it is too soon.
  std::optional<std::string> report(std::int64_t now_ns);

  std::uint64_t errors() const { return errors_; }

 private:
  std::uint64_t errors_ = 0;
  std::uint64_t lost_ = 0;
  std::map<std::string, std::uint64_t> kinds_;
  std::uint64_t reported_ = 0;  // errors and lost frames that were told
  std::optional<std::int64_t> last_report_ns_;
};

}  // namespace imunoise::can
