#include "core/diagnosis/views/spectral_view.h"

#include <algorithm>
#include <cmath>

#include "core/spectrum/bands.h"
#include "core/support/distributions.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

constexpr double kPointsEachDecade = 30.0;
constexpr double kTail = 0.025;

// Power over the model's of each replicate.
std::vector<Eigen::ArrayXd> relative_powers(const Current& current) {
  std::vector<Eigen::ArrayXd> out;
  for (std::size_t k = 0; k < current.cosines.size(); ++k)
    out.emplace_back(current.cosines[k].array().square() / current.spectrum[k]);
  return out;
}

// A stretch of frequencies, over all replicates.
struct PowerSum {
  double sum = 0.0;  // of powers over the model's
  double count = 0.0;
};

PowerSum sum_between(const std::vector<Eigen::ArrayXd>& relative, double low, double high) {
  PowerSum out;
  for (const Eigen::ArrayXd& one : relative) {
    const Index begin = coefficients_below(low, one.size() + 1);
    const Index end = coefficients_below(high, one.size() + 1);
    out.sum += one.segment(begin, end - begin).sum();
    out.count += static_cast<double>(end - begin);
  }
  return out;
}

// The largest mean over replicates at one of some frequencies, places of a transform of n samples;
// shorter replicates at the place that is nearest.
double strongest_mean(const std::vector<Eigen::ArrayXd>& relative, Index begin, Index end,
                      Index n) {
  double out = 0.0;
  for (Index place = begin; place < end; ++place) {
    double sum = 0.0;
    for (const Eigen::ArrayXd& one : relative) {
      const double nearest = static_cast<double>(place + 1) * static_cast<double>(one.size() + 1) /
                             static_cast<double>(n);
      sum += one(std::clamp<Index>(std::lround(nearest) - 1, 0, one.size() - 1));
    }
    out = std::max(out, sum / static_cast<double>(relative.size()));
  }
  return out;
}

}  // namespace

std::vector<SpectrumPoint> spectral_view(const Current& current) {
  const std::size_t longest = current.longest();
  const Index size = current.cosines[longest].size();
  const Index n = size + 1;
  const double rate = current.subject().rate.value;
  const std::vector<Eigen::ArrayXd> relative = relative_powers(current);
  const double ratio = std::pow(10.0, 1.0 / kPointsEachDecade);
  const double per_place = 0.5 / static_cast<double>(n);
  std::vector<SpectrumPoint> out;
  for (Index begin = 0; begin < size;) {
    const auto reach = static_cast<Index>(std::floor(static_cast<double>(begin + 1) * ratio));
    const Index end = std::min(size, std::max(begin + 1, reach - 1));
    const PowerSum part = sum_between(relative, per_place * static_cast<double>(begin + 1),
                                      per_place * static_cast<double>(end + 1));
    // The model is taken at the middle: what is shown is its line times the measured ratio.
    const Index middle = (begin + end - 1) / 2;
    const double level = 2.0 * current.spectrum[longest](middle) / rate;
    const double middle_place = std::sqrt(static_cast<double>((begin + 1) * end));
    out.push_back({.frequency = rate * per_place * middle_place,
                   .measured = level * part.sum / part.count,
                   .lower = level * part.sum / chi_square_quantile(1.0 - kTail, part.count),
                   .upper = level * part.sum / chi_square_quantile(kTail, part.count),
                   .model = level,
                   .peak = level * strongest_mean(relative, begin, end, n)});
    begin = end;
  }
  return out;
}

}  // namespace imunoise
