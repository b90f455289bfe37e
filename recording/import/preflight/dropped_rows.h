#pragma once

// Rows of a file that were dropped, so that the others can be told by the file's own count.

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

namespace imunoise::recording {

template <class Value>
void keep_others(std::vector<Value>& values, const std::vector<bool>& dropped) {
  std::size_t to = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!dropped[i]) values[to++] = values[i];
  }
  values.resize(to);
}

class DroppedRows {
 public:
  /// `rows`: ascending, as those are counted that were left.
  void add(const std::vector<std::size_t>& rows) {
    std::vector<std::size_t> counted;
    std::size_t before = 0;
    for (const std::size_t one : rows) {
      before = skipped(one, before);
      counted.push_back(one + before);
    }
    std::vector<std::size_t> all;
    std::merge(counted.begin(), counted.end(), rows_.begin(), rows_.end(), std::back_inserter(all));
    rows_ = std::move(all);
  }
  /// The i-th row that is left, as the file counts it.
  std::size_t counted(std::size_t i) const { return i + skipped(i, 0); }

 private:
  // How many were dropped before the i-th that is left, if it is known of `before`.
  std::size_t skipped(std::size_t i, std::size_t before) const {
    while (before < rows_.size() && rows_[before] - before <= i) ++before;
    return before;
  }

  std::vector<std::size_t> rows_;  // ascending, as the file counts them
};

}  // namespace imunoise::recording
