#pragma once

// Which columns of a file are wanted, and what the file or the user says their unit is.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/result.h"
#include "core/support/units.h"
#include "recording/import/table/options.h"

namespace imunoise::recording {

/// A table with more columns is a transposed one.
inline constexpr std::size_t kMaximumColumns = 4096;

/// A column that a file offers.
struct Offer {
  std::string name;
  bool by_default = true;  ///< Taken when the user names no channel.
  std::string unit{};      ///< As the file writes it.
};

/// Indices of the columns that `options` want: those that it names (as the file does, as imunoise
/// does or by any common name of their axis, or with wildcards), in that order, else all by
/// default; where what stands beside_them() is wanted, or axes to judge by, those too, behind them.
/// Error: a channel that the file
/// has not (those that exist are listed), two columns of one wanted name, no channel at all. `file`
/// is for messages.
Result<std::vector<std::size_t>> select_columns(std::string_view file,
                                                const std::vector<Offer>& offers,
                                                const ImportOptions& options);

/// Whether to read an unnamed channel beside named ones: never a count of ticks, unless
/// it is a witness that is asked for.
bool beside_them(const Offer& offer, const ImportOptions& options);

/// The unit of a channel: the user's, else what the file writes ("" and "-" state none), else what
/// the name implies. Error: an unknown unit of a channel that is not only a witness; a unit of
/// another quantity than the name's.
Result<Unit> resolve_unit(std::string_view file, std::string_view channel, std::string_view text,
                          const ImportOptions& options);

/// A rate that a file states. Error unless it is finite and positive. `where` says who states it.
Result<Hertz> checked_rate(std::string_view file, std::string_view where, double hertz);

}  // namespace imunoise::recording
