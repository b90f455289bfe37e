#include "daemon/acquire/wire_file.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace imunoise::acquire {

WireFile::~WireFile() { (void)close(); }

void WireFile::note(const Result<void>& done) {
  const std::lock_guard lock(mutex_);
  if (!done && !trouble_) trouble_ = done.error();
}

void WireFile::take(std::span<const std::uint8_t> bytes) {
  const std::lock_guard lock(mutex_);
  if (trouble_) return;
  if (waiting_.size() + bytes.size() > kMostWaiting) {
    lost_ += bytes.size();
    return;
  }
  waiting_ += std::string_view(static_cast<const char*>(static_cast<const void*>(bytes.data())),
                               bytes.size());
  work_.notify_one();
}

void WireFile::open(recording::FileSystem& files, const std::filesystem::path& path) {
  path_ = path;
  auto file = files.create(path);
  if (!file) return note(tl::make_unexpected(file.error()));
  file_ = std::move(*file);
  thread_ = std::thread([this] { run(); });
}

void WireFile::run() {
  for (bool last = false; !last;) {
    std::string bytes;
    {
      std::unique_lock lock(mutex_);
      work_.wait(lock, [&] { return closing_ || !waiting_.empty(); });
      last = closing_;
      if (!trouble_) bytes = std::exchange(waiting_, {});
      waiting_.clear();
    }
    if (!bytes.empty()) note(file_->write(bytes));
  }
}

Result<void> WireFile::close() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  work_.notify_one();
  if (thread_.joinable()) thread_.join();
  if (file_ && !trouble_) note(file_->sync());
  file_.reset();
  if (trouble_) return tl::make_unexpected(*trouble_);
  if (lost_ == 0) return {};
  return fail(fmt::format("{}: {} bytes are missing, because the disk was too slow", path_.string(),
                          lost_));
}

}  // namespace imunoise::acquire
