#pragma once

// Lines to rows of numbers.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "drivers/codec/unwrap.h"
#include "drivers/text/codec/columns.h"

namespace imunoise::text {

/// What the lines of a device look like.
struct LineForm {
  std::string prefix{};   ///< with which rows begin; other lines are passed over
  bool checksum = false;  ///< as in NMEA 0183: "$…*hh", hh the exclusive or of what is between
  std::optional<double> time_maximum{};  ///< last time before it is 0 again, in units of its column
};

struct TextRow {
  std::vector<std::optional<double>> values;  ///< of the channels; empty: not a number, or nothing
  std::optional<std::int64_t> time_ns;        ///< unwrapped, where a column holds it
  std::optional<std::uint64_t> counter;
};

/// What a line is besides a row.
enum class NoRow {
  kPassedOver,   ///< empty, a remark (#, %), a header, or without the prefix
  kBadChecksum,  ///< damaged
  kMalformed,    ///< too few or too many fields, or words where numbers should be
};

/// What stands in a line between a prefix and a checksum, where it has those of the form.
std::variant<std::string_view, NoRow> content_of(std::string_view line, const LineForm& form);

/// Reads rows of one device, in their order.
class RowReader {
 public:
  RowReader(std::vector<Column> columns, Separator separator, LineForm form);

  std::variant<TextRow, NoRow> read(std::string_view line);
  /// The device's clock may begin anew.
  void restart();
  const std::vector<Column>& columns() const { return columns_; }

 private:
  std::vector<Column> columns_;
  Separator separator_;
  LineForm form_;
  std::int64_t modulus_ns_ = 0;
  drivers::Unwrapper unwrap_;
};

}  // namespace imunoise::text
