#include "drivers/emulator/faults/fault_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "drivers/emulator/effects/call_text.h"

namespace imunoise::emulator {
namespace {

struct Entry {
  std::string_view name;
  std::string_view meaning;
  Fault::Kind kind;
  std::vector<NumberParameter> parameters;  // the sample, what is counted, the place
};

const std::vector<Entry>& entries() {
  constexpr double kMost = 1e15;  // whole numbers up to there are exact
  const NumberParameter sample = {"sample", "", {}, 0.0, kMost};
  const NumberParameter count = {"count", "", {}, 1.0, kMost};
  static const std::vector<Entry> kEntries = {
      {"bit_error",
       "a bit of the sample's message is flipped",
       Fault::Kind::kBitError,
       {sample, {"count", "", 1.0, 1.0, 1.0}, {"bit", "", 50.0, 0.0, kMost}}},
      {"loss",
       "bytes of the sample's message are lost (CAN: all of it)",
       Fault::Kind::kLoss,
       {sample, {"bytes", "", 1.0, 1.0, kMost}, {"byte", "", 6.0, 0.0, kMost}}},
      {"stall", "no samples are sent for `count` samples", Fault::Kind::kStall, {sample, count}},
      {"late",
       "`count` samples are delayed and arrive together",
       Fault::Kind::kLate,
       {sample, count}},
      {"unplug",
       "unplugged (CAN: off the bus) for `count` samples",
       Fault::Kind::kUnplug,
       {sample, count}},
  };
  return kEntries;
}

}  // namespace

Result<Fault> parse_fault(std::string_view text) {
  const auto call = parse_call(text);
  if (!call) return tl::make_unexpected(call.error());
  const auto entry = std::find_if(entries().begin(), entries().end(),
                                  [&](const Entry& e) { return e.name == call->name; });
  if (entry == entries().end()) {
    return fail(
        fmt::format("no fault '{}'; there are bit_error, loss, stall, late, unplug", call->name));
  }
  const auto numbers = numbers_of(*call, entry->parameters);
  if (!numbers) return tl::make_unexpected(numbers.error());
  const auto& n = *numbers;
  return Fault{entry->kind, static_cast<std::uint64_t>(n[0]), static_cast<std::uint64_t>(n[1]),
               n.size() > 2 ? static_cast<std::size_t>(n[2]) : 0};
}

Result<std::vector<Fault>> parse_faults(const std::vector<std::string>& texts) {
  std::vector<Fault> out;
  for (const std::string& text : texts) {
    const auto fault = parse_fault(text);
    if (!fault) return tl::make_unexpected(fault.error());
    out.push_back(*fault);
  }
  return out;
}

std::vector<std::string> describe_faults() {
  std::vector<std::string> out;
  for (const Entry& entry : entries()) {
    out.push_back(fmt::format("{}: {}", usage(entry.name, entry.parameters), entry.meaning));
  }
  return out;
}

}  // namespace imunoise::emulator
