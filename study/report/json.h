#pragma once

#include <google/protobuf/message.h>

#include <string>

namespace imunoise::report {

enum class JsonLayout { kIndented, kOneLine };

/// A message in protobuf's own JSON mapping as the house writes it: proto field names, zeros and
/// empty lists printed, enums as words, 64-bit integers as strings. NaN and infinity never appear:
/// an `optional` field that is not finite is left out, and any other is a programming error
/// (asserts). Text that is not UTF-8 is repaired. Thread-safe.
std::string to_json(const google::protobuf::Message& message,
                    JsonLayout layout = JsonLayout::kIndented);

}  // namespace imunoise::report
