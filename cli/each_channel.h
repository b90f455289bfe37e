#pragma once

#include <string>

#include "cli/input.h"
#include "cli/progress_line.h"

namespace imunoise::cli {

/// What an analysis gives for each channel, told as one line of progress that is called `doing`.
/// `analyse(series, progress)` returns the report of one channel, or an error.
template <class Reports, class Analyse>
Result<Reports> each_channel(const Subjects& subjects, const std::string& doing,
                             const Analyse& analyse) {
  Reports out;
  ProgressLine line(doing);
  for (std::size_t i = 0; i < subjects.series.size(); ++i) {
    const study::Series& series = subjects.series[i];
    auto done = analyse(series, line.part(i, subjects.series.size(), series.channel));
    if (!done) return tl::unexpected(done.error());
    *out.add_channels() = std::move(*done);
  }
  return out;
}

}  // namespace imunoise::cli
