#pragma once

// A device's streams, each with times of its own (topics of a log, messages of a bus): which of
// them make one table.

#include <string>
#include <string_view>
#include <vector>

#include "core/support/result.h"
#include "recording/import/table/options.h"
#include "recording/import/table/table.h"
#include "recording/import/table/times.h"

namespace imunoise::recording {

/// Samples that share their times. Values are as `columns` say; its samples are filled in last.
struct TimedStream {
  std::string name;             ///< "sensor_gyro_fifo"
  Times times;                  ///< rising but for the recorder's faults
  std::vector<Column> columns;  ///< samples are doubles
};

/// The stream of the first wanted channel (options.topic, options.channels), else the first that
/// holds angular rates, else the longest; and beside it those of its rate (to 1 %), each sample at
/// the row that is nearest in time, less the usual delay between the two. Rows that another stream
/// lacks miss its values. Notes say what was joined and what was left out; `kind` is what the user
/// calls a stream, and the option that chooses one. Error: no stream, none
/// of the wanted name or channel.
Result<Table> join_streams(const std::string& file, std::vector<TimedStream> streams,
                           const std::string& time_name, const ImportOptions& options,
                           std::string_view kind = "topic");

}  // namespace imunoise::recording
