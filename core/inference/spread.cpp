#include "core/inference/spread.h"

#include <algorithm>
#include <cmath>

#include "core/process/parameter_scale.h"
#include "core/support/distributions.h"
#include "core/support/holm.h"
#include "core/support/roots.h"

namespace imunoise {
namespace {

constexpr std::size_t kFewest = 3;

// Estimates of one quantity, each with its own error variance.
struct Effects {
  std::vector<double> value;
  std::vector<double> error2;

  double mean(double between2) const {
    double sum = 0.0;
    double weights = 0.0;
    for (std::size_t k = 0; k < value.size(); ++k) {
      const double w = 1.0 / (error2[k] + between2);
      sum += w * value[k];
      weights += w;
    }
    return sum / weights;
  }
  // Generalised Q, which falls as the variance between grows; χ² with size - 1 degrees of freedom
  // at the true one.
  double q(double between2) const {
    const double centre = mean(between2);
    double sum = 0.0;
    for (std::size_t k = 0; k < value.size(); ++k) {
      sum += (value[k] - centre) * (value[k] - centre) / (error2[k] + between2);
    }
    return sum;
  }
  // The variance between at which Q has a given value; zero when it is below that already.
  double between_at(double wanted) const {
    if (q(0.0) <= wanted) return 0.0;
    double high = *std::max_element(error2.begin(), error2.end());
    while (q(high) > wanted) high *= 4.0;
    return root_between([&](double between2) { return q(between2) - wanted; }, 0.0, high);
  }
};

ParameterSpread spread_of(const Effects& effects, const ParameterScale& scale) {
  const auto degrees = static_cast<double>(effects.value.size() - 1);
  const double between2 = effects.between_at(degrees);
  ParameterSpread out;
  out.replicates = static_cast<int>(effects.value.size());
  out.mean = scale.to_value(effects.mean(between2));
  const double slope = scale.slope(out.mean);
  out.relative = std::sqrt(between2);
  out.relative_lower = std::sqrt(effects.between_at(chi_square_quantile(0.975, degrees)));
  out.relative_upper = std::sqrt(effects.between_at(chi_square_quantile(0.025, degrees)));
  out.spread = slope * out.relative;
  out.lower = slope * out.relative_lower;
  out.upper = slope * out.relative_upper;
  out.p_value = chi_square_tail(effects.q(0.0), degrees);
  return out;
}

void correct_for_number(std::vector<ParameterSpread>& all) {
  std::vector<double> p_values;
  for (const ParameterSpread& one : all) p_values.push_back(one.p_value);
  const std::vector<double> corrected = holm(p_values);
  for (std::size_t i = 0; i < all.size(); ++i) all[i].p_value = corrected[i];
}

}  // namespace

std::vector<ParameterSpread> parameter_spread(std::span<const Estimate> separate,
                                              std::span<const WaveletVariance> replicates) {
  std::vector<Fit> fits;
  for (std::size_t k = 0; k < separate.size(); ++k) {
    fits.push_back(infer(separate[k], replicates.subspan(k, 1)));
  }
  std::vector<ParameterSpread> out;
  const Model& model = separate[0].model;
  for (std::size_t t = 0; t < model.terms.size(); ++t) {
    const std::vector<ParameterInfo> about = parameters(model.terms[t].process);
    for (std::size_t p = 0; p < about.size(); ++p) {
      const ParameterScale scale(about[p], p);
      Effects effects;
      for (const Fit& fit : fits) {
        const ParameterEstimate& seen = fit.parameters[t][p];
        if (seen.observability != Observability::kObserved) continue;
        effects.value.push_back(scale.to_scale(seen.value));
        const double error = seen.standard_error / scale.slope(seen.value);
        effects.error2.push_back(error * error);
      }
      if (effects.value.size() < kFewest) continue;
      out.push_back(spread_of(effects, scale));
      out.back().term = t;
      out.back().parameter = p;
    }
  }
  correct_for_number(out);
  return out;
}

}  // namespace imunoise
