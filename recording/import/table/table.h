#pragma once

// What each format's reader hands to import_files: numbers as stored, with what the file says of
// them.

#include <atomic>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/support/progress.h"
#include "core/support/units.h"
#include "recording/import/table/channel.h"

namespace imunoise::recording {

/// One channel as stored: value in `unit` = offset + scale · sample.
struct Column {
  std::string name;
  Samples samples;
  double scale = 1.0;
  double offset = 0.0;
  Unit unit;
};

/// The wanted channels of one file, all of one length.
struct Table {
  Hertz rate;
  std::vector<Column> columns;
  double jitter = 0.0;  ///< of a time column, see EvenTimes
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

 private:
  const Progress& whole_;
  std::atomic<double>& done_;
  double files_;
  double last_ = 0.0;
};

}  // namespace imunoise::recording
