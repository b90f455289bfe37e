#include "drivers/codec/wire_format.h"

#include <algorithm>

namespace imunoise::drivers {

std::string_view name_of(WireFormat format) {
  switch (format) {
    case WireFormat::kXbus:
      return "xbus";
    case WireFormat::kCandump:
      return "candump";
    case WireFormat::kAdis16405:
      break;
  }
  return "adis16405";
}

std::vector<std::string> wire_format_names() {
  std::vector<std::string> out;
  for (const WireFormat format : kWireFormats) out.emplace_back(name_of(format));
  return out;
}

std::optional<WireFormat> find_wire_format(std::string_view name) {
  const auto* const found =
      std::find_if(kWireFormats.begin(), kWireFormats.end(),
                   [&](WireFormat format) { return name_of(format) == name; });
  if (found == kWireFormats.end()) return std::nullopt;
  return *found;
}

}  // namespace imunoise::drivers
