#include "drivers/codec/refusal.h"

namespace imunoise::drivers {
namespace {

struct Words {
  std::string_view name;
  std::string_view meaning;
};

constexpr std::array<Words, kRefusals> kWords = {{
    {"outside_messages", "bytes outside messages: noise, or the capture began within a message"},
    {"checksum", "messages with a wrong checksum: bits or bytes were changed or lost"},
    {"length", "messages, items or signals of an impossible length"},
    {"truncated", "messages truncated at the end of the data"},
    {"unknown_item", "items with an unknown identifier, skipped by their length"},
    {"unknown_message", "CAN frames that the database does not describe"},
    {"no_layout", "legacy MTData before a Configuration message that says its layout"},
    {"device_error", "error messages of the device"},
    {"not_finite", "values that are not numbers"},
    {"out_of_range", "values marked as invalid by the device, or impossible"},
    {"stale", "bursts without new data: read before the sensor had updated"},
    {"torn", "bursts with old and new inertial words: read while the sensor updated"},
    {"no_answer", "bursts of ones: nothing drives the data line"},
    {"malformed_line", "lines that are not CAN frames in the format of candump -L"},
    {"error_frame", "CAN error frames: the bus or the controller has trouble"},
    {"remote_frame", "CAN remote frames, which carry no data"},
}};

}  // namespace

std::string_view name_of(Refusal refusal) { return kWords[static_cast<std::size_t>(refusal)].name; }

std::string_view meaning_of(Refusal refusal) {
  return kWords[static_cast<std::size_t>(refusal)].meaning;
}

}  // namespace imunoise::drivers
