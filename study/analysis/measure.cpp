#include "study/analysis/measure.h"

#include <algorithm>
#include <map>

#include "core/support/distributions.h"

namespace imunoise::study {
namespace {

template <class Message>
void add_scales(const WaveletVariance& wv, Message& to) {
  for (std::size_t i = 0; i < wv.scales.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double width = 2.0 * static_cast<double>(wv.scales[i]);
    to.add_scales(width);
    to.add_scales_s(width / wv.rate.value);
    to.add_variance(wv.variance(at));
    to.add_lower(wv.lower(at));
    to.add_upper(wv.upper(at));
  }
}

}  // namespace

Result<std::vector<WaveletVariance>> measure(const Series& series, const MeasureOptions& options,
                                             const Progress& progress) {
  std::vector<WaveletVariance> out;
  const auto count = static_cast<double>(series.replicates.size());
  for (std::size_t k = 0; k < series.replicates.size(); ++k) {
    const Signal& signal = series.replicates[k];
    const Scales scales = Scales::for_samples(signal.size(), options.per_octave);
    const Progress part =
        progress.part(static_cast<double>(k) / count, static_cast<double>(k + 1) / count);
    out.push_back(options.robust ? robust_wavelet_variance(signal, scales, *options.robust,
                                                           options.confidence, part)
                                 : wavelet_variance(signal, scales, options.confidence, part));
    if (progress.stopped()) return fail("stopped");
  }
  return out;
}

WaveletVariance pooled(const std::vector<WaveletVariance>& replicates) {
  struct Sum {
    double weight = 0.0;
    double variance = 0.0;
    double edof = 0.0;
  };
  std::map<std::int64_t, Sum> sums;
  WaveletVariance out;
  out.confidence = replicates.front().confidence;
  out.efficiency = replicates.front().efficiency;
  out.rate = replicates.front().rate;
  out.quantity = replicates.front().quantity;
  for (const WaveletVariance& wv : replicates) {
    out.samples += wv.samples;
    for (std::size_t i = 0; i < wv.scales.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const double weight =
          static_cast<double>(wv.samples) - 2.0 * static_cast<double>(wv.scales[i]) + 1.0;
      Sum& sum = sums[wv.scales[i]];
      sum.weight += weight;
      sum.variance += weight * wv.variance(at);
      sum.edof += wv.edof(at);
    }
  }
  std::vector<std::int64_t> scales;
  out.variance.resize(static_cast<Eigen::Index>(sums.size()));
  out.edof.resize(out.variance.size());
  for (const auto& [m, sum] : sums) {
    const auto at = static_cast<Eigen::Index>(scales.size());
    scales.push_back(m);
    out.variance(at) = sum.variance / sum.weight;
    out.edof(at) = sum.edof;
  }
  out.scales = Scales(std::move(scales));
  fill_interval(out);
  return out;
}

v1::WaveletVarianceReport wavelet_report(const Series& series,
                                         const std::vector<WaveletVariance>& measured) {
  v1::WaveletVarianceReport out;
  const WaveletVariance total = pooled(measured);
  out.set_channel(series.channel);
  out.set_unit(std::string(si_symbol(total.quantity)));
  out.set_rate_hz(total.rate.value);
  out.set_estimator(total.efficiency < 1.0 ? "robust" : "classical");
  out.set_efficiency(total.efficiency);
  out.set_confidence(total.confidence);
  add_scales(total, out);
  for (std::size_t k = 0; k < measured.size(); ++k) {
    v1::WaveletVariance& one = *out.add_replicates();
    add_scales(measured[k], one);
    for (const double edof : measured[k].edof) one.add_edof(edof);
    one.set_name(series.names[k]);
    one.set_samples(static_cast<std::uint32_t>(measured[k].samples));
  }
  return out;
}

}  // namespace imunoise::study
