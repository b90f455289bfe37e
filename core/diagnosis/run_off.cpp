#include "core/diagnosis/run_off.h"

#include <cmath>

#include "core/wavelet/wavelet_variance.h"

namespace imunoise {

RunOffs::RunOffs(const Trial& trial)
    : trial_(&trial), each_(trial.regression.subject().replicates()) {
  const Subject& subject = trial.regression.subject();
  Eigen::Index shortest = subject.length(0);
  for (std::size_t k = 1; k < subject.replicates(); ++k)
    shortest = std::min(shortest, subject.length(k));
  std::vector<std::int64_t> half_widths;
  for (const double seconds : {1.0, 10.0, 100.0, 1000.0}) {
    const auto m = std::lround(seconds * subject.rate.value);
    if (m < 1 || 2 * m > shortest || (!half_widths.empty() && m == half_widths.back())) continue;
    half_widths.push_back(m);
    seconds_.push_back(seconds);
  }
  half_widths_ = Scales(std::move(half_widths));
}

void RunOffs::add(std::size_t replicate, const Eigen::VectorXd& left) {
  if (seconds_.empty()) return;
  const std::span<const double> samples(left.data(), static_cast<std::size_t>(left.size()));
  const Hertz rate = trial_->regression.subject().rate;
  each_[replicate] = wavelet_variance(Signal(samples, rate), half_widths_).variance;
}

std::vector<RunOff> RunOffs::found() const {
  std::vector<RunOff> out;
  if (seconds_.empty()) return out;
  const Eigen::ArrayXd model = variance(trial_->fit.model.noise, half_widths_.half_widths());
  for (std::size_t i = 0; i < seconds_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    double mean = 0.0;
    for (const Eigen::ArrayXd& one : each_) mean += one(at) / static_cast<double>(each_.size());
    const double reach = 2.0 * seconds_[i];
    out.push_back({seconds_[i], reach * std::sqrt(model(at)), reach * std::sqrt(mean)});
  }
  return out;
}

}  // namespace imunoise
