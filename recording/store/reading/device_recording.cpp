#include "recording/store/reading/device_recording.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "core/support/counted.h"
#include "core/support/parallel.h"
#include "recording/store/format/layout.h"
#include "recording/store/journal/journal_reader.h"

namespace imunoise::recording {
namespace {

// Streams and channels: what samples of two chunks must share to be put together.
bool same_streams(const v1::RecordedDevice& a, const v1::RecordedDevice& b) {
  return a.streams_size() == b.streams_size() &&
         std::equal(a.streams().begin(), a.streams().end(), b.streams().begin(),
                    [](const v1::RecordedStream& x, const v1::RecordedStream& y) {
                      return x.SerializeAsString() == y.SerializeAsString();
                    });
}

// Chunks that are read together, on all threads.
constexpr std::size_t kTogether = 8;

class DeviceReader {
 public:
  DeviceReader(const FileSystem& files, const DeviceFolder& where, const v1::Manifest& manifest)
      : files_(files), where_(where), expected_(checksums(manifest)) {
    out_.where = where;
    for (const v1::RecordedDevice& device : manifest.devices()) {
      if (device.name() == where.device()) start(device);
    }
  }

  Result<DeviceRecording> run() {
    const auto names = list_device_files(files_, where_);
    if (!names) return tl::make_unexpected(names.error());
    for (const std::string& name : names->unfinished) {
      out_.defects.push_back(where_.file(name) +
                             ": is incomplete (imunoise verify --repair removes it)");
    }
    for (const std::string& name : names->broken) out_.broken.push_back(where_.file(name));
    using Read = tl::expected<ReadChunk, ChunkTrouble>;
    for (std::size_t first = 0; first < names->chunks.size(); first += kTogether) {
      std::vector<Read> read(std::min(kTogether, names->chunks.size() - first));
      for_each_index(read.size(), [&](std::size_t i) {
        read[i] = read_chunk(files_, where_, names->chunks[first + i], expected_);
      });
      for (auto& chunk : read) {
        if (auto done = add_chunk(std::move(chunk)); !done) {
          return tl::make_unexpected(done.error());
        }
      }
    }
    for (const auto& [file, checksum] : expected_) {
      const std::size_t slash = file.rfind('/');
      if (file.substr(0, slash) != where_.folder) continue;
      const auto number = number_of(file.substr(slash + 1), kChunkSuffix);
      if (number && !std::binary_search(names->chunks.begin(), names->chunks.end(), *number)) {
        out_.defects.push_back(file +
                               ": is missing; put it back, or imunoise verify --repair takes "
                               "it off the manifest");
      }
    }
    for (const std::uint64_t number : names->journals) {
      if (auto done = count_journal(number); !done) return tl::make_unexpected(done.error());
    }
    return std::move(out_);
  }

 private:
  void start(const v1::RecordedDevice& device) {
    out_.device = device;
    out_.streams.clear();
    for (const v1::RecordedStream& stream : device.streams()) {
      out_.streams.push_back(empty_rows(stream));
    }
    out_.in_journal.assign(out_.streams.size(), 0);
  }

  Result<void> add_chunk(tl::expected<ReadChunk, ChunkTrouble> read) {
    if (!read) {
      const bool damaged = read.error().kind == ChunkTrouble::Kind::kDamaged;
      out_.defects.push_back(read.error().message + (damaged ? keep_the_rest(out_.chunks) : ""));
      return {};
    }
    Chunk& chunk = read->chunk;
    if (out_.chunks == 0) start(chunk.device);
    if (!same_streams(out_.device, chunk.device)) {
      return fail(
          fmt::format("{}: has other streams or channels than the chunks before it; read it "
                      "by itself",
                      read->entry.file()));
    }
    if (chunk.first_sequence <= after_) {
      return fail(
          fmt::format("{}: holds blocks {} to {}, some of which an earlier chunk holds; "
                      "remove the copy",
                      read->entry.file(), chunk.first_sequence, chunk.last_sequence));
    }
    const bool torn = chunk.first_sequence != after_ + 1;
    for (std::size_t i = 0; i < chunk.streams.size(); ++i) {
      Rows& rows = chunk.streams[i];
      lost_before_.resize(chunk.streams.size(), false);
      lost_before_[i] = lost_before_[i] || torn;
      if (rows.size() > 0 && lost_before_[i]) {
        rows.flags.front() |= kLostBefore;
        lost_before_[i] = false;
      }
      if (out_.chunks == 0) {
        out_.streams[i] = std::move(rows);
      } else {
        append(out_.streams[i], rows);
      }
    }
    after_ = chunk.last_sequence;
    ++out_.chunks;
    return {};
  }

  Result<void> count_journal(std::uint64_t number) {
    const std::string name = where_.file(numbered(number, kJournalSuffix));
    const auto bytes = files_.read(where_.root / name);
    if (!bytes) return tl::make_unexpected(bytes.error());
    v1::JournalHeader header;
    *header.mutable_device() = out_.device;
    const auto segment =
        read_segment(*bytes, after_, out_.device.streams().empty() ? nullptr : &header);
    if (!segment) return fail(name + ": " + segment.error().message);
    std::uint64_t rows = 0;
    if (segment->chunk) {
      if (out_.streams.empty()) start(segment->chunk->device);
      for (std::size_t i = 0; i < segment->chunk->streams.size(); ++i) {
        rows += segment->chunk->streams[i].size();
        out_.in_journal[i] += segment->chunk->streams[i].size();
      }
      after_ = segment->chunk->last_sequence;
    }
    std::string damaged;
    if (!segment->damage.empty()) {
      damaged = fmt::format(", damaged in {}", counted(segment->damage.size(), "place"));
    }
    out_.defects.push_back(
        fmt::format("{}: {} not in a chunk yet{} (imunoise verify --repair makes one)", name,
                    counted(rows, "sample"), damaged));
    return {};
  }

  const FileSystem& files_;
  const DeviceFolder& where_;
  Checksums expected_;
  std::uint64_t after_ = 0;
  std::vector<bool> lost_before_;
  DeviceRecording out_;
};

}  // namespace

Result<DeviceRecording> read_device(const FileSystem& files, const DeviceFolder& where,
                                    const v1::Manifest& manifest) {
  return DeviceReader(files, where, manifest).run();
}

}  // namespace imunoise::recording
