#pragma once

// What each format's reader hands to the preflight: columns as they are stored, with what the file
// says of them. Readers do not judge: units, steps of time and missing values are the preflight's.

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/support/progress.h"
#include "core/support/units.h"
#include "recording/import/table/channel.h"
#include "recording/import/table/time_column.h"

namespace imunoise::recording {

/// One column as stored: value in `unit` = offset + scale · sample. A value that is missing or not
/// finite is a NaN (columns of integers that miss values become doubles).
struct Column {
  std::string name;
  Samples samples;
  double scale = 1.0;
  double offset = 0.0;
  std::string unit;  ///< As the file writes it; empty: it does not say.
};

/// A sampling rate that a file states.
struct StatedRate {
  double hertz = 0.0;
  std::string where;  ///< For messages: "the root attribute rate_hz".
};

/// The wanted columns of one file, all of one length, and what tells the rate: a time column, else
/// a rate that is stated. A reader leaves both out where the user states the rate.
struct Table {
  std::vector<Column> columns;
  std::optional<TimeColumn> time;
  std::optional<StatedRate> rate;
  /// Names a row for messages: "row 17" (line of a text file), "sample 16".
  std::function<std::string(std::size_t)> row = {};
  /// What the reader left out or chose, a sentence each: "column frame_id holds text: left out".
  std::vector<std::string> notes;
  /// Streams that are left out.
  std::vector<OtherStream> others = {};
  /// Rows that could not be read; their values are missing.
  std::size_t unreadable = 0;
  std::string first_unreadable;  ///< "row 22: 'abc' is not a number in column y"
  /// The file ends within a record, or lacks its end; what comes before is here.
  bool truncated = false;
};

/// Progress of one file among several that are read at the same time: reports the mean of all.
class FileProgress {
 public:
  FileProgress(const Progress& whole, std::atomic<double>& done, std::size_t files)
      : whole_(whole), done_(done), files_(static_cast<double>(files)) {}

  /// Reports a fraction done of this file, in [0, 1], never falling. From one thread.
  void report(double fraction) {
    const double step = (fraction - last_) / files_;
    last_ = fraction;
    whole_.report(done_.fetch_add(step) + step);
  }
  bool stopped() const { return whole_.stopped(); }
  /// For a part of the file whose progress is not told.
  Progress only_stopping() const { return whole_.part(0.0, 0.0); }

 private:
  const Progress& whole_;
  std::atomic<double>& done_;
  double files_;
  double last_ = 0.0;
};

}  // namespace imunoise::recording
