#pragma once

#include <span>
#include <vector>

#include "core/wavelet/wavelet_variance.h"

namespace imunoise {

/// One value a replicate; replicates of equal length, scales and efficiency share theirs.
template <class Value>
class PerReplicate {
 public:
  /// make(k) is called once for each distinct kind of replicate, k being the first of it.
  template <class Make>
  static PerReplicate of(std::span<const WaveletVariance> replicates, const Make& make) {
    PerReplicate out;
    for (std::size_t k = 0; k < replicates.size(); ++k) {
      std::size_t i = 0;
      while (i < out.first_.size() && !alike(replicates[out.first_[i]], replicates[k])) ++i;
      if (i == out.first_.size()) {
        out.first_.push_back(k);
        out.distinct_.push_back(make(k));
      }
      out.kind_.push_back(i);
    }
    return out;
  }

  const Value& operator[](std::size_t replicate) const { return distinct_[kind_[replicate]]; }
  std::size_t kinds() const { return distinct_.size(); }
  std::size_t kind(std::size_t replicate) const { return kind_[replicate]; }

 private:
  static bool alike(const WaveletVariance& a, const WaveletVariance& b) {
    return a.samples == b.samples && a.scales == b.scales && a.efficiency == b.efficiency;
  }

  std::vector<Value> distinct_;
  std::vector<std::size_t> first_;  // the first replicate of each kind
  std::vector<std::size_t> kind_;   // of each replicate
};

}  // namespace imunoise
