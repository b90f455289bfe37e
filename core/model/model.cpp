#include "core/model/model.h"

#include <algorithm>

namespace imunoise {

std::vector<ParameterPlace> parameter_places(const Model& model) {
  std::vector<ParameterPlace> out;
  for (std::size_t t = 0; t < model.terms.size(); ++t) {
    for (std::size_t p = 0; p < model.terms[t].given.size(); ++p) out.push_back({t, p});
  }
  return out;
}

std::size_t parameter_count(const Model& model) { return parameter_places(model).size(); }

std::string_view word_of(Sharing sharing) {
  switch (sharing) {
    case Sharing::kOwn:
      break;
    case Sharing::kCorrelated:
      return "corr";
    case Sharing::kGroup:
      return "group";
    case Sharing::kAll:
      return "all";
  }
  return "";
}

std::string_view word_of(Link link) {
  switch (link) {
    case Link::kConstant:
      break;
    case Link::kExponential:
      return "exp";
    case Link::kLinear:
      return "linear";
    case Link::kLogistic:
      return "logistic";
  }
  return "";
}

bool complete(const Model& model) {
  return std::all_of(model.terms.begin(), model.terms.end(), [](const Term& term) {
    return std::find(term.given.begin(), term.given.end(), false) == term.given.end();
  });
}

Eigen::ArrayXd variance(const Model& model, HalfWidths m) {
  Eigen::ArrayXd out = Eigen::ArrayXd::Zero(m.size());
  for (const Term& term : model.terms) out += variance(term.process, m);
  return out;
}

Eigen::ArrayXd spectrum(const Model& model, const Frequencies& frequency) {
  Eigen::ArrayXd out = Eigen::ArrayXd::Zero(frequency.size());
  for (const Term& term : model.terms) out += spectrum(term.process, frequency);
  return out;
}

Eigen::MatrixXd jacobian(const Model& model, HalfWidths m) {
  Eigen::MatrixXd out(m.size(), static_cast<Eigen::Index>(parameter_count(model)));
  Eigen::Index column = 0;
  for (const Term& term : model.terms) {
    const Eigen::ArrayXXd part = jacobian(term.process, m);
    out.middleCols(column, part.cols()) = part.matrix();
    column += part.cols();
  }
  return out;
}

int most_taps(const Model& model) {
  int out = 0;
  for (const Term& term : model.terms) out = std::max(out, taps(term.process));
  return out;
}

double innovation_deviation(const Model& model) {
  const Frequencies frequency(Eigen::ArrayXd::LinSpaced(1024, 0.5, 1023.5) / 2048.0);
  return std::exp(0.5 * spectrum(model, frequency).log().mean());
}

SumCovariance sum_covariance(const Model& model) {
  SumCovariance out;
  for (const Term& term : model.terms) {
    if (values(term.process).front() > 0.0) out += sum_covariance(term.process);
  }
  return out;
}

Model sorted(Model model) {
  const auto same_links = [](const Term& a, const Term& b) {
    return std::equal(a.trends.begin(), a.trends.end(), b.trends.begin(), b.trends.end(),
                      [](const Trend& x, const Trend& y) { return x.link == y.link; });
  };
  const auto shape_of = [](const Term& term) {
    std::vector<double> v = values(term.process);
    v.erase(v.begin());
    return v;
  };
  for (std::size_t i = 0; i < model.terms.size(); ++i) {
    for (std::size_t k = i + 1; k < model.terms.size(); ++k) {
      Term& a = model.terms[i];
      Term& b = model.terms[k];
      if (a.process.index() == b.process.index() && a.given == b.given && a.sharing == b.sharing &&
          same_links(a, b) && shape_of(a) < shape_of(b)) {
        std::swap(a, b);
      }
    }
  }
  return model;
}

std::vector<double> simulate(const Model& model, std::size_t n, std::uint64_t seed,
                             std::uint32_t replicate) {
  std::vector<double> out(n, 0.0);
  for (std::uint32_t i = 0; i < model.terms.size(); ++i) {
    RandomStream rng(seed, {replicate, i});
    add_samples(model.terms[i].process, rng, out);
  }
  return out;
}

}  // namespace imunoise
