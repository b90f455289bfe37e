#pragma once

// Little-endian fields taken from bytes one after the other, and a window that moves over a file.

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "recording/import/table/file.h"

namespace imunoise::recording {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they lie");

/// Takes fields from the front. Past the end everything is 0 or empty and ok() is false.
class Fields {
 public:
  explicit Fields(std::string_view bytes) : rest_(bytes) {}

  template <class Number>
  Number number() {
    Number out = 0;
    const std::string_view raw = bytes(sizeof out);
    if (ok_) std::memcpy(&out, raw.data(), sizeof out);
    return out;
  }
  std::string_view bytes(std::uint64_t count) {
    if (!ok_ || count > rest_.size()) {
      ok_ = false;
      return {};
    }
    const std::string_view out = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return out;
  }
  /// Bytes after their length.
  template <class Length>
  std::string_view counted() {
    return bytes(number<Length>());
  }
  bool ok() const { return ok_; }
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
  bool ok_ = true;
};

/// Bytes of a file by place, read in blocks: what is asked for in order is read once.
class Window {
 public:
  explicit Window(const File& file) : file_(file) {}

  /// Up to `count` bytes at `begin`, fewer at the end of the file; valid until the next call.
  Result<std::string_view> at(std::uint64_t begin, std::uint64_t count) {
    count = std::min(count, file_.size() - std::min(begin, file_.size()));
    if (begin < begin_ || begin + count > begin_ + held_.size()) {
      constexpr std::uint64_t block = std::uint64_t{1} << 20U;
      held_.resize(std::min(std::max(block, count), file_.size() - std::min(begin, file_.size())));
      begin_ = begin;
      const Result<std::size_t> got = file_.read_at(begin, held_);
      if (!got) return tl::make_unexpected(got.error());
      held_.resize(*got);
    }
    return std::string_view(held_).substr(std::min<std::uint64_t>(begin - begin_, held_.size()),
                                          count);
  }

 private:
  const File& file_;
  std::uint64_t begin_ = 0;
  std::string held_;
};

}  // namespace imunoise::recording
