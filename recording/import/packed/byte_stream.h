#pragma once

// Bytes of a file, one after the other, whether they lie there as they are or packed.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/support/result.h"
#include "recording/import/table/file.h"

namespace imunoise::recording {

/// Not thread-safe.
class ByteStream {
 public:
  virtual ~ByteStream() = default;
  /// Up to out.size() bytes; fewer only at the end. Error: the disk's, or damaged bytes.
  virtual Result<std::size_t> read(std::span<char> out) = 0;
  /// After the end: whether bytes are missing there.
  virtual bool truncated() const = 0;

  /// Passes over bytes; how many there were.
  Result<std::uint64_t> skip(std::uint64_t count) {
    std::array<char, 4096> ignored;
    std::uint64_t done = 0;
    while (done < count) {
      const std::uint64_t step = std::min<std::uint64_t>(ignored.size(), count - done);
      const Result<std::size_t> got = read(std::span(ignored).first(step));
      if (!got) return tl::make_unexpected(got.error());
      done += *got;
      if (*got < step) break;
    }
    return done;
  }
};

/// Bytes [begin, begin + count) of a file, as they are. Borrows the file.
class FileStream : public ByteStream {
 public:
  FileStream(const File& file, std::uint64_t begin, std::uint64_t count)
      : file_(file), at_(begin), left_(count) {}

  Result<std::size_t> read(std::span<char> out) override {
    out = out.first(std::min<std::uint64_t>(out.size(), left_));
    const Result<std::size_t> got = file_.read_at(at_, out);
    if (!got) return got;
    at_ += *got;
    left_ -= *got;
    truncated_ = truncated_ || *got < out.size();
    return got;
  }
  bool truncated() const override { return truncated_; }

 private:
  const File& file_;
  std::uint64_t at_;
  std::uint64_t left_;
  bool truncated_ = false;
};

/// Bytes in memory, which it borrows.
class MemoryStream : public ByteStream {
 public:
  explicit MemoryStream(std::string_view bytes) : rest_(bytes) {}

  Result<std::size_t> read(std::span<char> out) override {
    const std::size_t count = rest_.copy(out.data(), out.size());
    rest_.remove_prefix(count);
    return count;
  }
  bool truncated() const override { return false; }

 private:
  std::string_view rest_;
};

}  // namespace imunoise::recording
