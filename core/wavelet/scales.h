#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace imunoise {

/// Half-widths m of Haar wavelets, in samples, ascending. The averaging time of scale m is 2m
/// samples.
class Scales {
 public:
  Scales() = default;
  /// Any ascending half-widths m ≥ 1.
  explicit Scales(std::vector<std::int64_t> half_widths);

  /// The scales that `samples` samples support: dyadic m = 1, 2, 4 .. 2^(J-1), J = floor(log2
  /// samples) - 1, and between them, at 2 or 4 scales an octave, multiples of 1.5
  /// or 1.25, 1.5, 1.75 (where whole). `per_octave` is 1, 2 or 4; empty when there are fewer than 4
  /// samples.
  static Scales for_samples(std::size_t samples, int per_octave = 1);

  std::size_t size() const { return half_widths_.size(); }
  bool empty() const { return half_widths_.empty(); }
  std::int64_t operator[](std::size_t i) const { return half_widths_[i]; }
  std::int64_t largest() const { return half_widths_.back(); }
  auto begin() const { return half_widths_.begin(); }
  auto end() const { return half_widths_.end(); }

  /// The half-widths as numbers.
  Eigen::ArrayXd half_widths() const;
  /// These and others, each once.
  Scales with(const Scales& others) const;
  /// Only the scales at which `keep` is true (one entry a scale).
  Scales where(const std::vector<bool>& keep) const;

  friend bool operator==(const Scales&, const Scales&) = default;

 private:
  std::vector<std::int64_t> half_widths_;
};

}  // namespace imunoise
