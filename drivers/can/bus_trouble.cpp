#include "drivers/can/bus_trouble.h"

#include <fmt/format.h>
#include <linux/can/error.h>

#include <array>
#include <string_view>
#include <utility>
#include <vector>

namespace imunoise::can {
namespace {

constexpr std::int64_t kIntervalNs = 10'000'000'000;

constexpr std::array<std::pair<std::uint32_t, std::string_view>, 9> kKinds = {
    {{CAN_ERR_TX_TIMEOUT, "transmit timeout"},
     {CAN_ERR_LOSTARB, "lost arbitration"},
     {CAN_ERR_CRTL, "controller"},
     {CAN_ERR_PROT, "protocol violation"},
     {CAN_ERR_TRX, "transceiver"},
     {CAN_ERR_ACK, "no acknowledgement"},
     {CAN_ERR_BUSOFF, "bus-off"},
     {CAN_ERR_BUSERROR, "bus error"},
     {CAN_ERR_RESTARTED, "restarted"}}};

}  // namespace

bool BusTrouble::add_error(const drivers::CanFrame& frame) {
  ++errors_;
  for (const auto& [bit, word] : kKinds) {
    if ((frame.id & bit) != 0) ++kinds_[std::string(word)];
  }
  return (frame.id & CAN_ERR_BUSOFF) != 0;
}

std::optional<std::string> BusTrouble::report(std::int64_t now_ns) {
  if (errors_ + lost_ == reported_) return std::nullopt;
  if (last_report_ns_ && now_ns - *last_report_ns_ < kIntervalNs) return std::nullopt;
  reported_ = errors_ + lost_;
  last_report_ns_ = now_ns;
  std::vector<std::string> words;
  for (const auto& [word, count] : kinds_) words.push_back(fmt::format("{} {}", count, word));
  return fmt::format("so far {} error frames ({}), {} frames lost in the queue", errors_,
                     fmt::join(words, ", "), lost_);
}

}  // namespace imunoise::can
