#include "core/model/trend.h"

#include <algorithm>
#include <cmath>

#include "core/process/parameter_scale.h"

namespace imunoise {

std::vector<Link> possible_links(const ParameterInfo& info, std::size_t index) {
  if (index == 0) return {Link::kExponential, Link::kLinear};
  return {ParameterScale(info, index).logarithmic() ? Link::kExponential : Link::kLogistic};
}

Process process_at(const Term& term, double covariate) {
  if (!varies(term)) return term.process;
  const std::vector<ParameterInfo> about = parameters(term.process);
  std::vector<double> v = values(term.process);
  for (std::size_t p = 0; p < v.size(); ++p) {
    const double shift = term.trends[p].slope * covariate;
    switch (term.trends[p].link) {
      case Link::kConstant:
        break;
      case Link::kLinear:
        v[p] = std::max(0.0, v[p] + shift);
        break;
      case Link::kExponential:
      case Link::kLogistic: {
        if (p == 0) {
          v[p] *= std::exp(shift);
          break;
        }
        const ParameterScale scale(about[p], p);
        v[p] = std::clamp(scale.to_value(scale.to_scale(v[p]) + shift), about[p].lower,
                          about[p].upper);
        break;
      }
    }
  }
  Process out = term.process;
  set_values(out, v);
  return out;
}

Model model_at(const Model& model, double covariate) {
  Model out = model;
  for (Term& term : out.terms) {
    term.process = process_at(term, covariate);
    term.trends.assign(term.trends.size(), {});
  }
  return out;
}

Eigen::ArrayXd change_with(const Term& term, std::size_t index, double covariate, HalfWidths m) {
  const Process here = process_at(term, covariate);
  if (index == 0) return variance(here, m);
  const std::vector<double> v = values(here);
  const double speed = ParameterScale(parameters(here)[index], index).slope(v[index]);
  return v[0] * speed * shape_jacobian(here, m).col(static_cast<Eigen::Index>(index - 1));
}

bool varies(const Term& term) {
  return std::any_of(term.trends.begin(), term.trends.end(),
                     [](const Trend& trend) { return trend.link != Link::kConstant; });
}

bool varies(const Model& model) {
  return std::any_of(model.terms.begin(), model.terms.end(),
                     [](const Term& term) { return varies(term); });
}

Model with_varying_powers(Model model) {
  for (Term& term : model.terms) {
    if (!term.given[0]) term.trends[0].link = Link::kExponential;
  }
  return model;
}

}  // namespace imunoise
