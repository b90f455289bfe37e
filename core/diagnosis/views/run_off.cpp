#include "core/diagnosis/views/run_off.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace imunoise {
namespace {

constexpr std::array<double, 4> kSeconds{1.0, 10.0, 100.0, 1000.0};

std::int64_t half_width(double seconds, const Subject& subject) {
  return std::lround(seconds * subject.rate.value);
}

}  // namespace

Scales run_off_scales(const Subject& subject) {
  Eigen::Index shortest = subject.length(0);
  for (std::size_t k = 1; k < subject.replicates(); ++k)
    shortest = std::min(shortest, subject.length(k));
  std::vector<std::int64_t> out;
  for (const double seconds : kSeconds) {
    const std::int64_t m = half_width(seconds, subject);
    if (m >= 1 && 2 * m <= shortest && (out.empty() || m > out.back())) out.push_back(m);
  }
  return Scales(std::move(out));
}

std::vector<RunOff> run_off_of(const FittedModel& fitted,
                               const std::vector<WaveletVariance>& left) {
  const Subject& subject = fitted.regression.subject();
  std::vector<RunOff> out;
  for (const std::int64_t m : run_off_scales(subject)) {
    const Scales scale({m});
    const double seconds = *std::find_if(kSeconds.begin(), kSeconds.end(),
                                         [&](double one) { return half_width(one, subject) == m; });
    double mean = 0.0;
    for (const WaveletVariance& one : left)
      mean += at_scales(one, scale).variance(0) / static_cast<double>(left.size());
    const double model = variance(fitted.fit.model.noise, scale.half_widths())(0);
    std::int64_t stretches = 0;
    for (std::size_t k = 0; k < subject.replicates(); ++k) stretches += subject.length(k) / (2 * m);
    out.push_back(
        {seconds, 2.0 * seconds * std::sqrt(model), 2.0 * seconds * std::sqrt(mean), stretches});
  }
  return out;
}

}  // namespace imunoise
