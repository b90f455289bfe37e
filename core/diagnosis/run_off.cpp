#include "core/diagnosis/run_off.h"

#include <cmath>

#include "core/support/parallel.h"
#include "core/wavelet/wavelet_variance.h"

namespace imunoise {

std::vector<RunOff> run_off_of(const Trial& trial, const LeftOver& left) {
  const Subject& subject = trial.regression.subject();
  Eigen::Index shortest = subject.length(0);
  for (std::size_t k = 1; k < subject.replicates(); ++k)
    shortest = std::min(shortest, subject.length(k));
  std::vector<RunOff> out;
  std::vector<std::int64_t> half_widths;
  for (const double seconds : {1.0, 10.0, 100.0, 1000.0}) {
    const auto m = std::lround(seconds * subject.rate.value);
    if (m < 1 || 2 * m > shortest || (!half_widths.empty() && m == half_widths.back())) continue;
    half_widths.push_back(m);
    out.push_back({seconds, 0.0, 0.0});
  }
  if (out.empty()) return out;
  const Scales scales(half_widths);
  std::vector<Eigen::ArrayXd> each(subject.replicates());
  for_each_index(each.size(), [&](std::size_t k) {
    const Eigen::VectorXd& one = left.samples[k];
    const std::span<const double> samples(one.data(), static_cast<std::size_t>(one.size()));
    each[k] = wavelet_variance(Signal(samples, subject.rate), scales).variance;
  });
  const Eigen::ArrayXd model = variance(trial.fit.model.noise, scales.half_widths());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    double mean = 0.0;
    for (const Eigen::ArrayXd& one : each) mean += one(at) / static_cast<double>(each.size());
    out[i].measured = 2.0 * out[i].seconds * std::sqrt(mean);
    out[i].predicted = 2.0 * out[i].seconds * std::sqrt(model(at));
  }
  return out;
}

}  // namespace imunoise
