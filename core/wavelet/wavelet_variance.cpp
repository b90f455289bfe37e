#include "core/wavelet/wavelet_variance.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/support/distributions.h"
#include "core/wavelet/squared_coefficients.h"

namespace imunoise {
namespace {

template <class Prefix>
Eigen::ArrayXd mean_squares(const Prefix& prefix, const Scales& scales, const Progress& progress) {
  const auto totals = squared_coefficients(prefix, scales, progress);
  Eigen::ArrayXd out(static_cast<Eigen::Index>(scales.size()));
  for (std::size_t i = 0; i < scales.size(); ++i) {
    const auto m = static_cast<double>(scales[i]);
    const double count = static_cast<double>(prefix.samples()) - 2.0 * m + 1.0;
    out(static_cast<Eigen::Index>(i)) = static_cast<double>(totals[i]) / (count * 4.0 * m * m);
  }
  return out;
}

Eigen::ArrayXd mean_squares(std::span<const double> samples, const Scales& scales,
                            const Progress& progress) {
  return mean_squares(PrefixSums<double, double>(samples), scales, progress);
}

template <class Count>
Eigen::ArrayXd mean_squares(std::span<const Count> samples, const Scales& scales,
                            const Progress& progress) {
  const PrefixSums<Count, std::int32_t> narrow(samples);
  if (narrow.range_bound() <= kNarrowRange) return mean_squares(narrow, scales, progress);
  return mean_squares(PrefixSums<Count, std::int64_t>(samples), scales, progress);
}

}  // namespace

WaveletVariance wavelet_variance(const Signal& signal, const Scales& scales, double confidence,
                                 const Progress& progress) {
  assert(scales.empty() || static_cast<std::size_t>(2 * scales.largest()) <= signal.size());
  WaveletVariance out;
  out.scales = scales;
  out.confidence = confidence;
  out.samples = signal.size();
  out.rate = signal.rate();
  out.quantity = signal.quantity();
  out.variance = signal.scale() * signal.scale() *
                 std::visit([&](auto samples) { return mean_squares(samples, scales, progress); },
                            signal.samples());
  set_chi_square_interval(out);
  return out;
}

WaveletVariance at_scales(const WaveletVariance& wv, const Scales& scales) {
  WaveletVariance out = wv;
  out.scales = scales;
  out.variance.resize(static_cast<Eigen::Index>(scales.size()));
  for (std::size_t i = 0; i < scales.size(); ++i) {
    const auto found = std::lower_bound(wv.scales.begin(), wv.scales.end(), scales[i]);
    assert(found != wv.scales.end() && *found == scales[i]);
    out.variance(static_cast<Eigen::Index>(i)) = wv.variance(found - wv.scales.begin());
  }
  set_chi_square_interval(out);
  return out;
}

Eigen::ArrayXd equivalent_degrees(const Scales& scales, std::size_t samples) {
  const Eigen::ArrayXd m = scales.half_widths();
  return ((static_cast<double>(samples) - 2.0 * m + 1.0) / (2.0 * m)).max(1.0);
}

void set_chi_square_interval(WaveletVariance& wv) {
  wv.edof = equivalent_degrees(wv.scales, wv.samples);
  fill_interval(wv);
}

void fill_interval(WaveletVariance& wv) {
  wv.lower = wv.variance;
  wv.upper = wv.variance;
  const double tail = (1.0 - wv.confidence) / 2.0;
  const double widen = 1.0 / std::sqrt(wv.efficiency);
  for (Eigen::Index i = 0; i < wv.variance.size(); ++i) {
    const double low = wv.edof(i) / chi_square_quantile(1.0 - tail, wv.edof(i));
    const double high = wv.edof(i) / chi_square_quantile(tail, wv.edof(i));
    wv.lower(i) *= std::max(0.0, 1.0 - (1.0 - low) * widen);
    wv.upper(i) *= 1.0 + (high - 1.0) * widen;
  }
}

}  // namespace imunoise
