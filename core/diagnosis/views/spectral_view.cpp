#include "core/diagnosis/views/spectral_view.h"

#include <cmath>

#include "core/support/distributions.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

constexpr double kPointsEachDecade = 30.0;
constexpr double kTail = 0.025;

}  // namespace

std::vector<SpectrumPoint> spectral_view(const Current& current) {
  const Index size = current.cosines[0].size();
  const double rate = current.subject().rate.value;
  Eigen::ArrayXd relative = Eigen::ArrayXd::Zero(size);  // power over the model's
  double count = 0.0;
  for (std::size_t k = 0; k < current.cosines.size(); ++k) {
    if (current.cosines[k].size() != size) continue;
    relative += current.cosines[k].array().square() / current.spectrum[k];
    count += 1.0;
  }
  relative /= count;
  const double ratio = std::pow(10.0, 1.0 / kPointsEachDecade);
  const double per_place = 0.5 * rate / static_cast<double>(size + 1);  // Hz
  std::vector<SpectrumPoint> out;
  for (Index begin = 0; begin < size;) {
    const auto reach = static_cast<Index>(std::floor(static_cast<double>(begin + 1) * ratio));
    const Index end = std::min(size, std::max(begin + 1, reach - 1));
    const auto part = relative.segment(begin, end - begin);
    // The model is taken at the middle: what is shown is its line times the measured ratio.
    const Index middle = (begin + end - 1) / 2;
    const double level = 2.0 * current.spectrum[0](middle) / rate;
    const double freedom = count * static_cast<double>(end - begin);
    const double mean = part.mean();
    out.push_back({.frequency = per_place * std::sqrt(static_cast<double>((begin + 1) * end)),
                   .measured = level * mean,
                   .lower = level * mean * freedom / chi_square_quantile(1.0 - kTail, freedom),
                   .upper = level * mean * freedom / chi_square_quantile(kTail, freedom),
                   .model = level,
                   .peak = level * part.maxCoeff()});
    begin = end;
  }
  return out;
}

}  // namespace imunoise
