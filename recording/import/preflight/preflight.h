#pragma once

// One judge for all formats: what the columns of a file are, and which of its rows can be used.

#include <memory>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "recording/import/table/options.h"
#include "recording/import/table/table.h"

namespace imunoise::recording {

/// Rows [begin, begin + count) of a table, without a fault.
struct Stretch {
  std::size_t begin = 0;
  std::size_t count = 0;
  double seconds = 0.0;  ///< from the first row, or options.from, to its first
};

/// A table that was judged. Its columns hold no missing value within the stretches.
struct Judged {
  Hertz rate;
  double jitter = 0.0;
  std::size_t gaps = 0;    ///< of the time column
  std::uint64_t lost = 0;  ///< samples that are missing there
  std::vector<Column> columns;
  std::vector<Unit> units;  ///< of the columns
  std::vector<Stretch> stretches;
  std::shared_ptr<const Preflight> report;
};

/// Recognises time and units, finds every fault, and cuts at gaps and at samples that cannot be
/// used. Stretches shorter than a tenth of the longest, or than kMinimumSamples, are left out.
/// `file` is for messages. Error: an unknown unit, no rate, most rows unreadable, channels that
/// have values in different rows, no stretch left; with options.strict any finding.
/// Of the table's columns those with the names `wanted` come back, in this order; the others are
/// there to judge by.
Result<Judged> judge(const std::string& file, Table table, const std::vector<std::string>& wanted,
                     const ImportOptions& options);

}  // namespace imunoise::recording
