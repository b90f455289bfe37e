#pragma once

// The samples of recordings as a screen shows them.

#include <filesystem>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "daemon/service/api/answer.h"
#include "imunoise/v1/service.pb.h"
#include "recording/store/disk/file_system.h"
#include "recording/store/manifest/manifest.h"

namespace imunoise::service {

/// Reads a stream once, chunk by chunk, and keeps ranges of 64 samples of the streams that were
/// asked for last: a view of hours then needs no disk, one of seconds the chunks under it.
/// Thread-safe.
class RecordedSamples {
 public:
  /// `largest`: bytes of chunks of one device in one replicate that are read.
  explicit RecordedSamples(std::uint64_t largest) : largest_(largest) {}

  /// At most request.ranges() ranges of the samples from from_s to until_s; what is not in a chunk
  /// yet is not among them. Error: 400 for numbers that are none; 404 for a replicate, device,
  /// stream or channel that is not there; 409 for what is larger; 500 for a damaged chunk.
  Answer<v1::SampleRanges> ranges(const recording::FileSystem& files,
                                  const std::filesystem::path& root, const v1::Manifest& manifest,
                                  const v1::GetSamplesRequest& request);

 private:
  // A stream in one replicate.
  struct Overview {
    std::string key;
    recording::DeviceFolder where;
    std::vector<std::uint64_t> chunks;      // their numbers,
    std::vector<std::uint64_t> first_rows;  // the first row of each, and the number of all rows
    v1::RecordedStream stream;
    int place = 0;  // of the stream in its device
    v1::SampleRanges ranges;
  };
  Answer<std::shared_ptr<const Overview>> overview(const recording::FileSystem& files,
                                                   const std::filesystem::path& root,
                                                   const v1::Manifest& manifest,
                                                   const v1::GetSamplesRequest& request);
  static Answer<std::shared_ptr<const Overview>> read(const recording::FileSystem& files,
                                                      const v1::Manifest& manifest,
                                                      const std::string& stream, Overview out);
  static Answer<v1::SampleRanges> detail(const recording::FileSystem& files,
                                         const v1::Manifest& manifest, const Overview& of,
                                         std::uint64_t begin, std::uint64_t end,
                                         std::uint32_t samples_each);

  const std::uint64_t largest_;
  std::mutex mutex_;                                 // guards what follows
  std::list<std::shared_ptr<const Overview>> kept_;  // the latest first
};

}  // namespace imunoise::service
