#include "daemon/service/recordings/recorded_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "recording/store/reading/sample_ranges.h"

namespace imunoise::service {
namespace {

constexpr std::uint32_t kFine = 64;  // samples of a range that is kept
constexpr std::size_t kKeptOverviews = 4;
constexpr std::uint32_t kRanges = 1000;
constexpr std::uint32_t kMostRanges = 4000;

Answer<void> check_ranges(const v1::GetSamplesRequest& request) {
  if (request.ranges() > kMostRanges)
    return refuse(400, fmt::format("ranges: a number from 1 to {}", kMostRanges));
  const double until = request.has_until_s() ? request.until_s() : 1e18;
  if (!(request.from_s() >= 0.0 && request.from_s() < until && until <= 1e18))
    return refuse(400, "from_s, until_s: seconds, from_s before until_s");
  return {};
}

Answer<recording::DeviceFolder> folder_of(const recording::FileSystem& files,
                                          const std::filesystem::path& root,
                                          std::uint32_t replicate, const std::string& device) {
  const auto all = recording::find_device_folders(files, root, replicate);
  if (!all) return refuse(500, all.error().message);
  for (const recording::DeviceFolder& one : *all) {
    if (one.device() == device) return one;
  }
  return refuse(404, fmt::format("replicate {} holds no device '{}'; the manifest lists those that "
                                 "the recording has",
                                 replicate, device));
}

Answer<std::vector<int>> places_of(const v1::SampleRanges& ranges,
                                   const google::protobuf::RepeatedPtrField<std::string>& names) {
  std::vector<int> out;
  for (int c = 0; names.empty() && c < ranges.channels_size(); ++c) out.push_back(c);
  for (const std::string& name : names) {
    const auto found =
        std::find_if(ranges.channels().begin(), ranges.channels().end(),
                     [&](const v1::RangeChannel& one) { return one.channel() == name; });
    if (found == ranges.channels().end())
      return refuse(404, fmt::format("stream '{}' has no channel '{}'", ranges.stream(), name));
    out.push_back(static_cast<int>(found - ranges.channels().begin()));
  }
  return out;
}

}  // namespace

Answer<std::shared_ptr<const RecordedSamples::Overview>> RecordedSamples::read(
    const recording::FileSystem& files, const v1::Manifest& manifest, const std::string& stream,
    Overview out) {
  std::optional<recording::RangeBuilder> builder;
  std::optional<std::int64_t> begin_ns;
  std::int64_t end_ns = 0;
  const recording::Checksums expected = recording::checksums(manifest);
  out.first_rows = {0};
  for (const std::uint64_t number : out.chunks) {
    const auto read = recording::read_chunk(files, out.where, number, expected);
    if (!read) return refuse(500, read.error().message);
    const auto& streams = read->chunk.device.streams();
    if (!builder) {
      const auto found = std::find_if(streams.begin(), streams.end(), [&](const auto& one) {
        return stream.empty() || one.name() == stream;
      });
      if (found == streams.end())
        return refuse(404,
                      fmt::format("device '{}' has no stream '{}'", out.where.device(), stream));
      out.place = static_cast<int>(found - streams.begin());
      out.stream = *found;
      builder.emplace(out.stream, kFine);
    }
    if (streams.size() <= out.place ||
        streams[out.place].SerializeAsString() != out.stream.SerializeAsString())
      return refuse(500, out.where.folder + ": its chunks have different channels");
    const recording::Rows& rows = read->chunk.streams[static_cast<std::size_t>(out.place)];
    builder->take(rows, 0, rows.size());
    out.first_rows.push_back(out.first_rows.back() + rows.size());
    if (rows.size() == 0) continue;
    if (!begin_ns) begin_ns = rows.host_time.front();
    end_ns = rows.host_time.back();
  }
  if (!begin_ns)
    return refuse(404, "no sample of this device is in a chunk yet; ask again in a few minutes");
  out.ranges = std::move(*builder).finish(*begin_ns);
  out.ranges.set_length_s(1e-9 * static_cast<double>(end_ns - *begin_ns));
  return std::make_shared<const Overview>(std::move(out));
}

Answer<std::shared_ptr<const RecordedSamples::Overview>> RecordedSamples::overview(
    const recording::FileSystem& files, const std::filesystem::path& root,
    const v1::Manifest& manifest, const v1::GetSamplesRequest& request) {
  auto where = folder_of(files, root, std::max(1U, request.replicate()), request.device());
  if (!where) return tl::unexpected(where.error());
  auto names = recording::list_device_files(files, *where);
  if (!names) return refuse(500, names.error().message);
  std::uint64_t bytes = 0;
  for (const v1::ChunkEntry& one : manifest.chunks()) {
    if (one.file().starts_with(where->folder + "/")) bytes += one.bytes();
  }
  if (bytes > largest_)
    return refuse(409, fmt::format("device '{}' has {} MiB in this replicate, more than the {} MiB "
                                   "that are shown here; use imunoise wv --split-into",
                                   request.device(), bytes >> 20U, largest_ >> 20U));
  Overview begun;
  begun.key = fmt::format("{}|{}|{}|{}", where->path().string(), request.stream(),
                          recording::fingerprint(manifest), names->chunks.size());
  {
    const std::lock_guard lock(mutex_);
    for (auto one = kept_.begin(); one != kept_.end(); ++one) {
      if ((*one)->key != begun.key) continue;
      kept_.splice(kept_.begin(), kept_, one);
      return kept_.front();
    }
  }
  begun.where = std::move(*where);
  begun.chunks = std::move(names->chunks);
  auto made = read(files, manifest, request.stream(), std::move(begun));
  if (!made) return made;
  const std::lock_guard lock(mutex_);
  kept_.push_front(*made);
  if (kept_.size() > kKeptOverviews) kept_.pop_back();
  return made;
}

// Rows [begin, end), of the chunks that hold them.
Answer<v1::SampleRanges> RecordedSamples::detail(const recording::FileSystem& files,
                                                 const v1::Manifest& manifest, const Overview& of,
                                                 std::uint64_t begin, std::uint64_t end,
                                                 std::uint32_t samples_each) {
  recording::RangeBuilder builder(of.stream, samples_each);
  const recording::Checksums expected = recording::checksums(manifest);
  for (std::size_t k = 0; k < of.chunks.size(); ++k) {
    const std::uint64_t first = of.first_rows[k];
    const std::uint64_t from = std::max(begin, first);
    const std::uint64_t to = std::min(end, of.first_rows[k + 1]);
    if (from >= to) continue;
    const auto read = recording::read_chunk(files, of.where, of.chunks[k], expected);
    if (!read) return refuse(500, read.error().message);
    const recording::Rows& rows = read->chunk.streams[static_cast<std::size_t>(of.place)];
    if (rows.size() < to - first) return refuse(409, "the recording changed; ask again");
    builder.take(rows, from - first, to - first);
  }
  return std::move(builder).finish(of.ranges.begin_ns());
}

Answer<v1::SampleRanges> RecordedSamples::ranges(const recording::FileSystem& files,
                                                 const std::filesystem::path& root,
                                                 const v1::Manifest& manifest,
                                                 const v1::GetSamplesRequest& request) {
  if (auto good = check_ranges(request); !good) return tl::unexpected(good.error());
  const auto found = overview(files, root, manifest, request);
  if (!found) return tl::unexpected(found.error());
  const Overview& of = **found;
  const auto channels = places_of(of.ranges, request.channel());
  if (!channels) return tl::unexpected(channels.error());

  const auto& times = of.ranges.time_s();
  const auto after = [&](double time) {
    return static_cast<int>(std::upper_bound(times.begin(), times.end(), time) - times.begin());
  };
  const int begin = std::max(0, after(request.from_s()) - 1);
  const int end =
      request.has_until_s() ? std::max(begin + 1, after(request.until_s())) : times.size();
  const auto wanted = static_cast<int>(request.ranges() == 0 ? kRanges : request.ranges());
  v1::SampleRanges out;
  if (end - begin >= wanted) {
    const int together = (end - begin + wanted - 1) / wanted;
    out = recording::coarser(of.ranges, begin, end, together, *channels);
  } else {
    const auto first = static_cast<std::uint64_t>(begin) * kFine;
    const std::uint64_t last =
        std::min(static_cast<std::uint64_t>(end) * kFine, of.first_rows.back());
    const auto each = static_cast<std::uint32_t>(
        std::max<std::uint64_t>(1, (last - first) / static_cast<std::uint64_t>(wanted)));
    auto fine = detail(files, manifest, of, first, last, each);
    if (!fine) return fine;
    out = recording::coarser(*fine, 0, fine->time_s_size(), 1, *channels);
  }
  out.set_replicate(std::max(1U, request.replicate()));
  out.set_length_s(of.ranges.length_s());
  return out;
}

}  // namespace imunoise::service
