#pragma once

// Between the words of drivers and those of recordings.

#include <string>

#include "drivers/host/block.h"
#include "recording/store/stream/stream.h"

namespace imunoise::acquire {

/// The description under which a device is recorded. A channel named like a column that every
/// stream has ("counter") is recorded as "counter_channel".
v1::RecordedDevice recorded_device(const std::string& name, const std::string& driver,
                                   const drivers::DeviceInfo& info);

/// What a read delivered, as the recorder takes it. The first row carries kLostBefore where the
/// driver refused samples since the last block or says that samples were lost; the driver's other
/// flags keep their bits. A refused sample is counted once, under the channel that was to blame
/// where there is just one.
recording::Block recorded_block(const drivers::SampleBlock& block);

}  // namespace imunoise::acquire
