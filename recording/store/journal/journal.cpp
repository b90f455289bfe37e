#include "recording/store/journal/journal.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "recording/store/format/format_version.h"
#include "recording/store/format/layout.h"
#include "recording/store/journal/journal_format.h"

namespace imunoise::recording {

Journal::Journal(FileSystem& files, std::filesystem::path folder, v1::RecordedDevice device,
                 const JournalPlace& place, const SegmentLimits& limits, double first_share)
    : files_(files),
      folder_(std::move(folder)),
      device_(std::move(device)),
      place_(place),
      limits_(limits),
      share_(first_share),
      acknowledged_(place.sequence - 1) {}

std::uint64_t Journal::append(const Block& block) {
  assert(check_block(device_, block));
  pending_ += block_frame(place_.sequence, block);
  for (const std::int64_t time : block.rows.host_time) {
    begin_ns_ = timed_ ? std::min(begin_ns_, time) : time;
    end_ns_ = timed_ ? std::max(end_ns_, time) : time;
    timed_ = true;
  }
  return place_.sequence++;
}

Result<void> Journal::sync() {
  if (pending_.empty()) return {};
  if (auto done = write_pending(); !done) {
    abandon_segment();
    return done;
  }
  acknowledged_ = place_.sequence - 1;
  bytes_ += pending_.size();
  pending_.clear();
  const auto time = static_cast<double>(end_ns_) - static_cast<double>(begin_ns_);
  if (static_cast<double>(bytes_) >= share_ * static_cast<double>(limits_.bytes) ||
      time >= share_ * static_cast<double>(limits_.time.count())) {
    end_segment();
  }
  return {};
}

Result<void> Journal::write_pending() {
  const bool fresh = file_ == nullptr;
  if (fresh) {
    auto file = files_.create(folder_ / numbered(place_.segment, kJournalSuffix));
    if (!file) return tl::make_unexpected(file.error());
    file_ = std::move(*file);
    v1::JournalHeader header;
    header.set_version(kFormatVersion);
    header.set_replicate(place_.replicate);
    header.set_segment(place_.segment);
    *header.mutable_device() = device_;
    if (auto done = file_->write(header_frame(header)); !done) return done;
  }
  if (auto done = file_->write(pending_); !done) return done;
  if (auto done = file_->sync(); !done) return done;
  return fresh ? files_.sync_folder(folder_) : Result<void>();
}

void Journal::abandon_segment() {
  if (bytes_ > 0) {
    end_segment();  // what was acknowledged in it becomes a chunk
  } else if (file_ != nullptr) {
    file_.reset();
    abandoned_.push_back(place_.segment++);
    remove_abandoned();
  }
}

// What the disk does not let go now is tried again, at last by a recovery.
void Journal::remove_abandoned() {
  std::erase_if(abandoned_, [&](std::uint64_t segment) {
    return files_.remove(folder_ / numbered(segment, kJournalSuffix)).has_value();
  });
}

void Journal::end_segment() {
  remove_abandoned();
  if (file_ == nullptr) return;
  file_.reset();
  ended_.push_back(place_.segment++);
  bytes_ = 0;
  share_ = 1.0;
  timed_ = false;
}

}  // namespace imunoise::recording
