#pragma once

#include <string_view>

#include "core/support/result.h"
#include "drivers/can/codec/database.h"

namespace imunoise::drivers {

/// Reads the text of a DBC file: BO_ and SG_ (both byte orders, signed and unsigned), SIG_VALTYPE_
/// (float, double), multiplexed signals with M, mN, mNM and SG_MUL_VAL_. Comments, attributes,
/// value tables and nodes are skipped. Thread-safe.
///
/// Error: "file:line:column: what is wrong", also for a signal that does not fit into its message,
/// a factor of zero, an identifier defined twice.
Result<CanDatabase> parse_dbc(std::string_view text, std::string_view file);

}  // namespace imunoise::drivers
