#include "drivers/host/check.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>
#include <utility>

#include "core/support/utf8.h"
#include "drivers/host/option_values.h"

namespace imunoise::drivers {
namespace {

// More than anybody needs, few enough that a wild count is caught before it is followed.
constexpr std::uint32_t kMostParts = 4096;
constexpr std::size_t kLongestName = 128;   // bytes
constexpr std::size_t kLongestText = 4096;  // bytes

/// Keeps the first complaint; what follows it is not looked at.
class Complaint {
 public:
  bool require(bool good, std::string_view place, std::string_view what) {
    if (!good && text_.empty()) text_ = fmt::format("{}: {}", place, what);
    return text_.empty();
  }
  bool none() const { return text_.empty(); }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// Text of a plugin that only describes, "" for none; bytes that are no UTF-8 become U+FFFD.
std::string description(const char* from, std::string_view place, Complaint& complaint) {
  if (from == nullptr) return {};
  const std::size_t length = ::strnlen(from, kLongestText + 1);
  if (!complaint.require(length <= kLongestText, place, "a text has no end")) return {};
  std::string out(from, length);
  const bool printable = std::none_of(out.begin(), out.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 || byte == 0x7f;
  });
  complaint.require(printable, place, "a text has control characters");
  return is_utf8(out) ? out : repaired_utf8(out);
}

/// Text of a plugin that says what is recorded, "" for none. It must be what the driver means: two
/// devices whose serial numbers were repaired could become one.
std::string text(const char* from, std::string_view place, Complaint& complaint) {
  std::string out = description(from, place, complaint);
  complaint.require(from == nullptr || is_utf8({from, ::strnlen(from, kLongestText)}), place,
                    fmt::format("'{}' is not UTF-8; the driver must convert it", out));
  return out;
}

/// A name that must be there. Names become parts of files: no '/'.
std::string name(const char* from, std::string_view place, Complaint& complaint) {
  std::string out = text(from, place, complaint);
  complaint.require(!out.empty(), place, "has no name");
  complaint.require(out.size() <= kLongestName && out.find('/') == std::string::npos, place,
                    "its name is too long or contains '/'");
  return out;
}

/// A name that people type: lower case letters, digits, '_' and what `more` allows.
std::string plain_name(const char* from, std::string_view more, std::string_view place,
                       Complaint& complaint) {
  std::string out = name(from, place, complaint);
  const bool plain = std::all_of(out.begin(), out.end(), [&](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' ||
           more.find(c) != std::string_view::npos;
  });
  complaint.require(plain, place,
                    fmt::format("its name '{}' has other characters than lower case letters, "
                                "digits and '_'",
                                out));
  return out;
}

/// Reads the parts of a list with `read(part, place)`; they need names of their own.
template <class Part, class Read>
auto list(const Part* const* parts, std::uint32_t count, std::string_view kind,
          std::string_view place, Complaint& complaint, Read&& read) {
  std::vector<decltype(read(**parts, std::string()))> out;
  complaint.require(count <= kMostParts, place, fmt::format("claims {} {}s", count, kind));
  complaint.require(count == 0 || parts != nullptr, place, fmt::format("its {}s are NULL", kind));
  for (std::uint32_t i = 0; i < count && complaint.none(); ++i) {
    const std::string here =
        place.empty() ? fmt::format("{} {}", kind, i) : fmt::format("{}: {} {}", place, kind, i);
    const Part* const part = parts[i];
    if (!complaint.require(part != nullptr, here, "is NULL") ||
        !complaint.require(part->size >= sizeof(Part), here, "its struct is too small")) {
      break;
    }
    out.push_back(read(*part, here));
    const auto twin = [&](const auto& other) { return other.name == out.back().name; };
    complaint.require(std::none_of(out.begin(), out.end() - 1, twin), here,
                      fmt::format("its name '{}' is taken", out.back().name));
  }
  return out;
}

Channel channel(const imunoise_channel& from, const std::string& place, Complaint& complaint) {
  Channel out;
  out.name = name(from.name, place, complaint);
  out.long_name = description(from.long_name, place, complaint);
  out.units = text(from.units, place + ": units", complaint);
  complaint.require(!out.units.empty(), place, "has no units; \"1\" says that none is known");
  const bool known = from.number_type >= IMUNOISE_INT16 && from.number_type <= IMUNOISE_FLOAT64;
  complaint.require(known, place, fmt::format("unknown number type {}", from.number_type));
  if (known) out.type = static_cast<NumberType>(from.number_type);
  out.scale_factor = from.scale_factor;
  complaint.require(std::isfinite(out.scale_factor) && out.scale_factor != 0.0, place,
                    fmt::format("scale_factor is {}", out.scale_factor));
  out.add_offset = from.add_offset;
  complaint.require(std::isfinite(out.add_offset), place,
                    fmt::format("add_offset is {}", out.add_offset));
  return out;
}

Stream stream(const imunoise_stream& from, const std::string& place, Complaint& complaint) {
  Stream out;
  out.name = name(from.name, place, complaint);
  complaint.require(from.channel_count > 0, place, "has no channels");
  out.channels = list(from.channels, from.channel_count, "channel", place, complaint,
                      [&](const imunoise_channel& part, const std::string& here) {
                        return channel(part, here, complaint);
                      });
  out.nominal_rate_hz = from.nominal_rate_hz;
  complaint.require(std::isfinite(out.nominal_rate_hz) && out.nominal_rate_hz >= 0.0, place,
                    fmt::format("nominal rate is {} Hz", out.nominal_rate_hz));
  out.counter_maximum = from.counter_maximum;
  out.device_time_tick_s = from.device_time_tick_s;
  complaint.require(std::isfinite(out.device_time_tick_s) && out.device_time_tick_s >= 0.0, place,
                    fmt::format("device time ticks every {} s", out.device_time_tick_s));
  return out;
}

std::vector<Stream> streams(const imunoise_stream* const* from, std::uint32_t count,
                            Complaint& complaint) {
  return list(from, count, "stream", "", complaint,
              [&](const imunoise_stream& part, const std::string& here) {
                return stream(part, here, complaint);
              });
}

Option option(const imunoise_option& from, const std::string& place, Complaint& complaint) {
  Option out;
  out.name = plain_name(from.name, "", place, complaint);
  out.description = description(from.description, place, complaint);
  out.unit = description(from.unit, place, complaint);
  const bool known = from.type >= IMUNOISE_OPTION_FLAG && from.type <= IMUNOISE_OPTION_TEXT;
  complaint.require(known, place, fmt::format("unknown option type {}", from.type));
  if (known) out.type = static_cast<OptionType>(from.type);
  out.required = (from.properties & IMUNOISE_OPTION_REQUIRED) != 0;
  out.repeated = (from.properties & IMUNOISE_OPTION_REPEATED) != 0;
  out.minimum = from.minimum;
  out.maximum = from.maximum;
  complaint.require(out.minimum <= out.maximum, place,
                    fmt::format("allows values from {} to {}", out.minimum, out.maximum));
  complaint.require(from.choice_count <= kMostParts && (from.choice_count == 0 || from.choices),
                    place, "its choices are NULL or too many");
  for (std::uint32_t i = 0; i < from.choice_count && complaint.none(); ++i) {
    out.choices.push_back(name(from.choices[i], place + ": choice", complaint));
  }
  if (from.default_value == nullptr) return out;
  out.by_default = text(from.default_value, place, complaint);
  complaint.require(!out.required, place, "is required, yet has a default");
  const Result<void> sound = check_value(out, *out.by_default);
  if (!sound) complaint.require(false, place, "its default: " + sound.error().message);
  return out;
}

}  // namespace

Result<DriverInfo> check_driver(const imunoise_driver* table) {
  if (table == nullptr) {
    return fail(fmt::format("has no driver for ABI {}; rebuild it against this version's headers",
                            IMUNOISE_DRIVER_ABI));
  }
  // Size and ABI first: nothing else of the table may be there.
  if (table->abi != IMUNOISE_DRIVER_ABI) {
    return fail(
        fmt::format("speaks ABI {}, this program ABI {}; rebuild it against this version's "
                    "headers",
                    table->abi, IMUNOISE_DRIVER_ABI));
  }
  if (table->size < sizeof(imunoise_driver)) {
    return fail(fmt::format("its table has {} bytes, ABI {} needs {}; rebuild it", table->size,
                            IMUNOISE_DRIVER_ABI, sizeof(imunoise_driver)));
  }
  if (table->open == nullptr || table->describe == nullptr || table->read == nullptr ||
      table->cancel == nullptr || table->close == nullptr) {
    return fail("lacks one of open, describe, read, cancel, close");
  }
  Complaint complaint;
  DriverInfo out;
  out.name = plain_name(table->name, "-", "the driver", complaint);
  out.description = description(table->description, "description", complaint);
  out.version = description(table->version, "version", complaint);
  out.options = list(table->options, table->option_count, "option", "", complaint,
                     [&](const imunoise_option& part, const std::string& here) {
                       return option(part, here, complaint);
                     });
  out.streams = streams(table->streams, table->stream_count, complaint);
  if (!complaint.none()) return fail(complaint.text());
  return out;
}

Result<DeviceInfo> check_device(const imunoise_device_info* table) {
  if (table == nullptr || table->size < sizeof(imunoise_device_info)) {
    return fail("describes the device by NULL, or by a struct that is too small");
  }
  Complaint complaint;
  DeviceInfo out;
  complaint.require(table->stream_count > 0, "the device", "has no streams");
  out.streams = streams(table->streams, table->stream_count, complaint);
  out.product = description(table->product, "product", complaint);
  out.serial = text(table->serial, "serial", complaint);
  out.firmware = description(table->firmware, "firmware", complaint);
  if (!complaint.none()) return fail(complaint.text());
  return out;
}

}  // namespace imunoise::drivers
