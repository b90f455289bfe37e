#pragma once

// Times of samples as they are read, at half the memory of their numbers.

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "recording/import/table/blocks.h"

namespace imunoise::recording {

/// Times in ns that come one by one, any numbers. Blocks of them whose members lie within 2 s of
/// steps of one length hold 4 bytes a time, other blocks 8.
class Times {
 public:
  void push(std::int64_t time) {
    open_.push_back(time);
    if (open_.size() == kNumbers) close();
  }
  std::size_t size() const { return closed_.size() * kNumbers + open_.size(); }
  bool empty() const { return size() == 0; }
  std::int64_t operator[](std::size_t at) const {
    const std::size_t block = at / kNumbers;
    return block < closed_.size() ? closed_[block].at(at % kNumbers) : open_[at % kNumbers];
  }
  /// All of them; none stay behind.
  std::vector<std::int64_t> take() {
    std::vector<std::int64_t> out;
    out.reserve(size());
    for (Block& block : closed_) {
      for (std::size_t i = 0; i < kNumbers; ++i) out.push_back(block.at(i));
      block = {};
    }
    out.insert(out.end(), open_.begin(), open_.end());
    *this = {};
    return out;
  }

 private:
  static constexpr std::size_t kNumbers = std::size_t{1} << 16U;
  template <class Number>
  using Numbers = std::vector<Number, Pages<Number>>;

  // Either every time, or how far each lies from steps that begin at the first. Sums wrap, as times
  // of a damaged file may.
  struct Block {
    Numbers<std::int64_t> times;
    std::uint64_t first = 0;
    std::uint64_t step = 0;
    Numbers<std::int32_t> away;

    std::int64_t at(std::size_t i) const {
      if (away.empty()) return times[i];
      return static_cast<std::int64_t>(first + i * step + static_cast<std::uint64_t>(away[i]));
    }
  };

  void close() {
    Block out;
    out.first = static_cast<std::uint64_t>(open_.front());
    out.step = (static_cast<std::uint64_t>(open_.back()) - out.first) / (kNumbers - 1);
    out.away.reserve(kNumbers);
    for (std::size_t i = 0; i < kNumbers; ++i) {
      const auto away = static_cast<std::int64_t>(static_cast<std::uint64_t>(open_[i]) - out.first -
                                                  i * out.step);
      const auto narrow = static_cast<std::int32_t>(away);
      if (narrow != away) break;
      out.away.push_back(narrow);
    }
    if (out.away.size() < kNumbers) {
      out.away = {};
      out.times.assign(open_.begin(), open_.end());
    }
    closed_.push_back(std::move(out));
    open_.clear();
  }

  std::vector<Block> closed_;
  std::vector<std::int64_t> open_;  // the last block, not yet full
};

}  // namespace imunoise::recording
