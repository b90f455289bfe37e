#include "core/dynamic/trend_start.h"

#include <algorithm>
#include <cmath>

#include "core/model/trend.h"
#include "core/process/parameter_scale.h"

namespace imunoise {
namespace {

// A straight line through weighted points.
class Line {
 public:
  void add(double x, double y, double weight) {
    sum_ += weight;
    x_ += weight * x;
    y_ += weight * y;
    xx_ += weight * x * x;
    xy_ += weight * x * y;
  }
  bool empty() const { return !(sum_ > 0.0); }
  double slope() const {
    const double spread = xx_ - x_ * x_ / sum_;
    return spread > 1e-9 * xx_ ? (xy_ - x_ * y_ / sum_) / spread : 0.0;
  }
  double mean() const { return y_ / sum_; }
  double middle(double slope) const { return (y_ - slope * x_) / sum_; }

 private:
  double sum_ = 0.0;
  double x_ = 0.0;
  double y_ = 0.0;
  double xx_ = 0.0;
  double xy_ = 0.0;
};

// One parameter's estimates over the covariate, on its scale.
Line line_of(const ParameterScale& scale, std::size_t term, std::size_t parameter,
             const std::vector<double>& covariates,
             const std::vector<std::optional<Fit>>& separate) {
  Line out;
  for (std::size_t b = 0; b < separate.size(); ++b) {
    if (!separate[b]) continue;
    const ParameterEstimate& one = separate[b]->parameters[term][parameter];
    if (one.observability != Observability::kObserved) continue;
    const double error = one.standard_error / scale.slope(one.value);
    if (error > 0.0 && std::isfinite(error)) {
      out.add(covariates[b], scale.to_scale(one.value), 1.0 / (error * error));
    }
  }
  return out;
}

}  // namespace

std::vector<Model> trend_starts(const Model& open, const std::vector<double>& covariates,
                                const std::vector<std::optional<Fit>>& separate) {
  Model sloping = open;
  Model flat = open;
  for (std::size_t t = 0; t < open.terms.size(); ++t) {
    const std::vector<ParameterInfo> about = parameters(open.terms[t].process);
    std::vector<double> v = values(open.terms[t].process);
    std::vector<double> mean = v;
    for (std::size_t p = 0; p < v.size(); ++p) {
      if (open.terms[t].given[p]) continue;
      const ParameterScale scale(about[p], p);
      const Line line = line_of(scale, t, p, covariates, separate);
      if (line.empty()) continue;
      Trend& trend = sloping.terms[t].trends[p];
      const bool follows = trend.link != Link::kConstant && trend.link != Link::kLinear;
      if (follows) trend.slope = std::clamp(line.slope(), -kSteepestTrend, kSteepestTrend);
      if (p == 0) continue;  // powers are solved for
      v[p] = std::clamp(scale.to_value(line.middle(follows ? trend.slope : 0.0)), about[p].lower,
                        about[p].upper);
      mean[p] = std::clamp(scale.to_value(line.mean()), about[p].lower, about[p].upper);
    }
    set_values(sloping.terms[t].process, v);
    set_values(flat.terms[t].process, mean);
  }
  return {sloping, flat};
}

}  // namespace imunoise
