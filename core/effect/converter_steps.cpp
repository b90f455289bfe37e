#include "core/effect/converter_steps.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/support/neighbour_steps.h"
#include "core/support/parallel.h"

namespace imunoise {

bool ConverterSteps::is_coarse() const {
  // The kurtosis then depends on where between two codes the mean lies: by 0.005 at 0.75 steps, by
  // 0.03 at two thirds of one.
  constexpr double kCoarse = 0.75;
  return noise < kCoarse;
}

double ConverterSteps::excess_kurtosis(double innovation) const {
  const double ratio = step / innovation;
  return -ratio * ratio * ratio * ratio / 120.0;
}

ConverterSteps converter_steps(const Subject& subject) {
  std::vector<ConverterSteps> each(subject.replicates());
  for_each_index(each.size(), [&](std::size_t k) {
    const SharedVector& samples = subject.samples[k];
    const NeighbourSteps steps =
        neighbour_steps({samples.data(), static_cast<std::size_t>(samples.size())});
    if (!(steps.mean_square > 0.0)) return;
    each[k] = {steps.smallest, steps.noise_in_steps()};
  });
  return *std::min_element(each.begin(), each.end(),
                           [](const ConverterSteps& one, const ConverterSteps& other) {
                             return one.noise < other.noise;
                           });
}

}  // namespace imunoise
