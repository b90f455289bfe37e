#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/support/result.h"
#include "drivers/emulator/faults/fault.h"

namespace imunoise::emulator {

/// Reads "unplug(sample=500, count=100)"; samples are counted from 0. Error: a fault that there is
/// not, numbers that it does not take.
Result<Fault> parse_fault(std::string_view text);
Result<std::vector<Fault>> parse_faults(const std::vector<std::string>& texts);

/// What there is: a line for each fault, how it is written and what it does.
std::vector<std::string> describe_faults();

}  // namespace imunoise::emulator
