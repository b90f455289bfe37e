#pragma once

#include <cstddef>
#include <vector>

namespace imunoise::recording {

/// Numbers that come one by one, kept in blocks: memory holds them once.
template <class Number>
class Blocks {
 public:
  void push(Number value) {
    if (blocks_.empty() || blocks_.back().size() == kNumbers) {
      blocks_.emplace_back().reserve(kNumbers);
    }
    blocks_.back().push_back(value);
  }
  std::size_t size() const {
    return blocks_.empty() ? 0 : (blocks_.size() - 1) * kNumbers + blocks_.back().size();
  }
  /// All of them; none stay behind.
  std::vector<Number> take() {
    std::vector<Number> out;
    out.reserve(size());
    for (std::vector<Number>& block : blocks_) {
      out.insert(out.end(), block.begin(), block.end());
      block = {};
    }
    blocks_.clear();
    return out;
  }

 private:
  static constexpr std::size_t kNumbers = std::size_t{1} << 16U;
  std::vector<std::vector<Number>> blocks_;
};

}  // namespace imunoise::recording
