#include "study/analysis/comparison.h"

#include <cmath>

#include "core/diagnosis/views/lag_curves.h"
#include "core/diagnosis/views/normal_power.h"
#include "core/diagnosis/views/scale_kurtosis.h"
#include "core/diagnosis/views/sensor_pairs.h"
#include "core/diagnosis/views/spectral_view.h"

namespace imunoise::study {
namespace {

// The wavelet variance of each replicate at each scale, as a normal score under the model.
void add_replicates(const FittedModel& trial, const LeftOver& left,
                    const std::vector<std::string>& names, v1::Comparison& to) {
  const Model& noise = trial.fit.model.noise;
  for (std::size_t k = 0; k < left.variances.size(); ++k) {
    const WaveletVariance& own = left.variances[k];
    const Eigen::ArrayXd nu = variance(noise, own.scales.half_widths());
    const Eigen::ArrayXd spread = left.covariances[k].diagonal().array();
    v1::ReplicateResidual& one = *to.add_replicates();
    one.set_name(names[k]);
    one.set_samples(static_cast<std::uint32_t>(own.samples));
    for (std::size_t i = 0; i < own.scales.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      one.add_scales_s(2.0 * static_cast<double>(own.scales[i]) / own.rate.value);
      one.add_measured(own.variance(at));
      const double dof = spread(at) > 0.0 ? 2.0 * nu(at) * nu(at) / spread(at) : 0.0;
      one.add_residual(dof > 0.0 ? normal_score(own.variance(at) / nu(at), dof) : 0.0);
    }
  }
}

void add_spectrum(const Current& current, v1::Comparison& to) {
  for (const SpectrumPoint& from : spectral_view(current)) {
    v1::SpectrumPoint& point = *to.add_spectrum();
    point.set_frequency_hz(from.frequency);
    point.set_measured(from.measured);
    point.set_lower(from.lower);
    point.set_upper(from.upper);
    point.set_model(from.model);
    point.set_peak(from.peak);
  }
}

void add_innovations(const FittedModel& trial, const std::vector<std::string>& names,
                     v1::Comparison& to) {
  const Subject& subject = trial.regression.subject();
  const double rate = subject.rate.value;
  const Innovations white = innovations(trial.regression, trial.fit);
  for (const ScaleKurtosis& from : scale_kurtosis(white, rate)) {
    v1::ScaleKurtosis& one = *to.add_kurtosis();
    one.set_seconds(from.seconds);
    one.set_excess(from.excess);
    one.set_error(from.error);
  }
  for (std::size_t i = 0; i < white.white.size(); ++i) {
    const std::size_t k = white.replicates[i];
    const double begins = subject.begins(k);
    for (const TimeMisfit& from : time_misfits(white.white[i], k, rate)) {
      v1::TimeStretch& one = *to.add_times();
      one.set_replicate(names[k]);
      one.set_from(begins + from.from);
      one.set_to(begins + from.to);
      one.set_ratio(from.ratio);
      one.set_sigma(from.sigma);
    }
  }
}

void add_pairs(const Current& current, const std::string& channel, v1::Comparison& to) {
  const Subject& subject = current.subject();
  const auto name = [&](std::size_t place) {
    return place == 0 ? channel : subject.witnesses[place - 1].name;
  };
  for (const SensorPair& from : sensor_pairs(current)) {
    v1::SharedMotion& one = *to.add_pairs();
    one.set_first(name(from.first));
    one.set_second(name(from.second));
    one.set_from_hz(from.from);
    one.set_to_hz(from.to);
    one.set_correlation(from.correlation);
    one.set_sigma(from.sigma);
    one.set_p(from.p_value);
  }
}

void add_lags(const Current& current, v1::Comparison& to) {
  for (const LagCurve& from : lag_curves(current)) {
    v1::LagCurve& one = *to.add_lags();
    one.set_witness(from.witness);
    for (const double seconds : from.seconds) one.add_seconds(seconds);
    for (const double nats : from.nats) one.add_nats(nats);
    one.set_chance_nats(from.chance);
  }
}

}  // namespace

v1::Comparison comparison_of(const FittedModel& trial, const LeftOver& left,
                             const std::string& channel,
                             const std::vector<std::string>& replicates) {
  v1::Comparison out;
  add_replicates(trial, left, replicates, out);
  add_innovations(trial, replicates, out);
  const Current current = current_of(trial.regression, trial.fit);
  add_spectrum(current, out);
  add_pairs(current, channel, out);
  add_lags(current, out);
  return out;
}

}  // namespace imunoise::study
