#include "daemon/acquire/wire_file.h"

#include <string_view>
#include <utility>

namespace imunoise::acquire {

void WireFile::note(const Result<void>& done) {
  if (!done && !trouble_) trouble_ = done.error();
}

void WireFile::take(std::span<const std::uint8_t> bytes) {
  const std::lock_guard lock(mutex_);
  const std::string_view text(static_cast<const char*>(static_cast<const void*>(bytes.data())),
                              bytes.size());
  if (trouble_) return;
  if (file_) {
    note(file_->write(text));
  } else {
    early_ += text;
  }
}

void WireFile::open(recording::FileSystem& files, const std::filesystem::path& path) {
  const std::lock_guard lock(mutex_);
  auto file = files.create(path);
  if (!file) {
    trouble_ = file.error();
    return;
  }
  file_ = std::move(*file);
  note(file_->write(std::exchange(early_, {})));
}

Result<void> WireFile::close() {
  const std::lock_guard lock(mutex_);
  if (file_ && !trouble_) note(file_->sync());
  file_.reset();
  if (trouble_) return tl::make_unexpected(*trouble_);
  return {};
}

}  // namespace imunoise::acquire
