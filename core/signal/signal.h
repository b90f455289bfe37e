#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>

#include "core/support/units.h"

namespace imunoise {

/// One axis: evenly sampled, free of gaps, borrowed (the caller keeps the memory alive).
/// The value of sample i in SI units is offset + scale · samples[i]. Thread-safe to read.
class Signal {
 public:
  using Samples = std::variant<std::span<const double>, std::span<const std::int16_t>,
                               std::span<const std::int32_t>>;

  Signal(Samples samples, Hertz rate, Quantity quantity = Quantity::kUnknown, double scale = 1.0,
         double offset = 0.0)
      : samples_(samples), rate_(rate), quantity_(quantity), scale_(scale), offset_(offset) {}

  const Samples& samples() const { return samples_; }
  Hertz rate() const { return rate_; }
  Quantity quantity() const { return quantity_; }
  /// SI units per stored unit.
  double scale() const { return scale_; }
  /// SI units. Constant, hence invisible to the wavelet variance.
  double offset() const { return offset_; }

  std::size_t size() const {
    return std::visit([](auto samples) { return samples.size(); }, samples_);
  }
  /// Sample i in SI units.
  double value(std::size_t i) const {
    return offset_ +
           scale_ * std::visit([i](auto s) { return static_cast<double>(s[i]); }, samples_);
  }
  /// Whether all samples are the same. Their mean taken off may leave rounding, no zeros.
  bool never_changes() const {
    return std::visit(
        [](auto s) { return std::all_of(s.begin(), s.end(), [&](auto x) { return x == s[0]; }); },
        samples_);
  }
  /// The contiguous part [begin, begin + count).
  Signal part(std::size_t begin, std::size_t count) const {
    Signal out = *this;
    out.samples_ = std::visit([&](auto s) { return Samples(s.subspan(begin, count)); }, samples_);
    return out;
  }

 private:
  Samples samples_;
  Hertz rate_;
  Quantity quantity_;
  double scale_;
  double offset_;
};

}  // namespace imunoise
