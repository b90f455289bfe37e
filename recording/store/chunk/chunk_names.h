#pragma once

// Names inside a chunk file that its writer and its reader share.

namespace imunoise::recording::chunk_names {

// Of the root group.
inline constexpr const char* kVersion = "imunoise_chunk";
inline constexpr const char* kReplicate = "replicate";
inline constexpr const char* kDevice = "device";
inline constexpr const char* kDriver = "driver";
inline constexpr const char* kSerial = "serial";
inline constexpr const char* kFirstSequence = "first_sequence";
inline constexpr const char* kLastSequence = "last_sequence";
inline constexpr const char* kStreams = "streams";     // how many groups there are
inline constexpr const char* kMetadata = "metadata.";  // followed by the key
// Of a stream's group.
inline constexpr const char* kOrder =
    "order";  // of streams in the device, of channels in the stream
inline constexpr const char* kChannels = "channels";  // how many datasets beside the stream's own
inline constexpr const char* kRate = "rate_hz";
inline constexpr const char* kModulus = "counter_modulus";
inline constexpr const char* kStep = "counter_step";
inline constexpr const char* kReceived = "received";
inline constexpr const char* kRefused = "refused.";  // followed by the reason; of a channel too
// The stream's own datasets.
inline constexpr const char* kHostTime = "host_time";
inline constexpr const char* kCounter = "counter";
inline constexpr const char* kFlags = "flags";
// Of a channel's dataset.
inline constexpr const char* kUnits = "units";
inline constexpr const char* kScale = "scale_factor";
inline constexpr const char* kOffset = "add_offset";
inline constexpr const char* kLongName = "long_name";
inline constexpr const char* kValidMin = "valid_min";
inline constexpr const char* kValidMax = "valid_max";

}  // namespace imunoise::recording::chunk_names
