#pragma once

// What the user chose for a driver, checked against what the driver offers.

#include <deque>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/result.h"
#include "drivers/description.h"

namespace imunoise::drivers {

/// One choice as a user writes it: name=value.
struct OptionText {
  std::string name;
  std::string value;
};

/// Takes "name=value" apart. Error: no '='.
Result<OptionText> parse_option(std::string_view text);

/// Error unless `value` is one that the option allows: of its type, within its bounds, among its
/// choices, and a text in UTF-8. Numbers are written as in "100", "0.5", "1e-3"; flags as true or
/// false.
Result<void> check_value(const Option& option, std::string_view value);

/// The values of all options as driver.h has them, in the order of the options. Movable.
class OptionValues {
 public:
  /// Fills in defaults. Errors name the option and what it allows: a name the driver has not, a
  /// value it does not allow, one given twice that is not repeated, a required one not given.
  static Result<OptionValues> make(const std::vector<Option>& options,
                                   std::span<const OptionText> chosen);

  const imunoise_option_value* const* data() const { return pointers_.data(); }
  std::uint32_t size() const { return static_cast<std::uint32_t>(pointers_.size()); }

 private:
  Result<void> add(const Option& option, const std::string& value);

  std::deque<OptionText> texts_;  // a deque does not move what the values point to
  std::deque<imunoise_option_value> values_;
  std::vector<const imunoise_option_value*> pointers_;
};

}  // namespace imunoise::drivers
