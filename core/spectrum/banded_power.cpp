#include "core/spectrum/banded_power.h"

#include <cassert>

#include "core/spectrum/cosine_transform.h"
#include "core/spectrum/cross_power.h"

namespace imunoise {
namespace {

// Of a series (n × 1).
BandedPower banded(const Eigen::MatrixXd& series, Hertz rate) {
  const Eigen::Index n = series.rows();
  Eigen::MatrixXd with_ramp(n, 2);
  with_ramp << series, Eigen::VectorXd::LinSpaced(n, 0.0, static_cast<double>(n - 1));
  const CrossPower both = cross_power(with_ramp, rate);
  const auto entry = [&](Eigen::Index row, Eigen::Index column) {
    Eigen::ArrayXd out(both.frequency.size());
    for (Eigen::Index b = 0; b < out.size(); ++b)
      out(b) = both.power[static_cast<std::size_t>(b)](row, column);
    return out;
  };
  return {both.frequency, both.count, entry(0, 0), entry(0, 1), entry(1, 1), both.samples, rate};
}

}  // namespace

BandedPower bands_of(std::size_t n, Hertz rate) {
  return banded(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(quick_length(n)), 1), rate);
}

BandedPower banded_power(const Signal& signal) {
  return banded(samples_of(std::span(&signal, 1)), signal.rate());
}

}  // namespace imunoise
