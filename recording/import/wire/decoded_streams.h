#pragma once

// Samples of a driver's codec, collected into a table.

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "drivers/codec/stream_decoder.h"
#include "recording/import/table/blocks.h"
#include "recording/import/table/file.h"
#include "recording/import/table/options.h"
#include "recording/import/table/streams.h"
#include "recording/import/table/table.h"

namespace imunoise::recording {

/// Runs a whole file through a decoder. What the decoder refused, and what the device's counter
/// misses, is told. Streams of one rate are joined (join_streams()). Error: no sample, no time
/// stamp and no --rate.
Result<Table> read_decoded(const File& file, drivers::StreamDecoder& decoder,
                           const ImportOptions& options, FileProgress& progress);

}  // namespace imunoise::recording
