#include "core/effect/columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "core/spectrum/cosine_transform.h"
#include "core/support/parallel.h"

namespace imunoise {

using Index = Eigen::Index;

std::vector<SharedVector> columns_of(Eigen::MatrixXd matrix) {
  const auto shared = std::make_shared<const Eigen::MatrixXd>(std::move(matrix));
  std::vector<SharedVector> out;
  for (Index i = 0; i < shared->cols(); ++i)
    out.emplace_back(shared, shared->col(i).data(), shared->rows());
  return out;
}

Regressors in_all(const Subject& subject, bool own, const std::vector<std::string>& names,
                  const std::function<Columns(std::size_t k)>& columns_in) {
  Regressors out;
  const auto q = static_cast<Index>(names.size());
  out.replicates.resize(subject.replicates());
  for_each_index(subject.replicates(), [&](std::size_t k) { out.replicates[k] = columns_in(k); });
  for (std::size_t k = 0; k < subject.replicates(); ++k) {
    for (Index i = 0; i < q; ++i)
      out.replicates[k].places.push_back(i + (own ? static_cast<Index>(k) * q : 0));
    if (k > 0 && !own) continue;
    for (const std::string& name : names)
      out.coefficients.push_back({name, own ? k : CoefficientName::kAll});
  }
  return out;
}

Regressors shaped(const Subject& subject, bool own, const std::vector<std::string>& names,
                  const ShapeFrom& shape) {
  const auto key = [&](std::size_t k) {
    return std::pair(subject.length(k), subject.parts[k].first);
  };
  std::map<std::pair<Index, Index>, std::vector<SharedVector>> made;
  for (std::size_t k = 0; k < subject.replicates(); ++k) made[key(k)];
  std::vector<decltype(made)::iterator> each;
  for (auto one = made.begin(); one != made.end(); ++one) each.push_back(one);
  for_each_index(each.size(), [&](std::size_t i) {
    const auto [length, first] = each[i]->first;
    each[i]->second = columns_of(shape(first).cosines(length));
  });
  return in_all(subject, own, names, [&](std::size_t k) {
    return Columns{made.at(key(k)), {}, {}};
  });
}

Regressors regressors_of(const EffectTerm& term, const Subject& subject) {
  if (term.effect->regressors == nullptr) return {std::vector<Columns>(subject.replicates()), {}};
  return made_even(term.effect->regressors(term, subject), subject, 0);
}

Regressors made_even(Regressors columns, const Subject& subject, std::size_t known) {
  if (known == subject.evenings.size()) return columns;
  std::vector<std::pair<std::size_t, SharedVector*>> each;
  for (std::size_t k = 0; k < columns.replicates.size(); ++k) {
    columns.replicates[k].samples.clear();
    for (SharedVector& one : columns.replicates[k].cosines) each.emplace_back(k, &one);
  }
  for_each_index(each.size(), [&](std::size_t i) {
    const auto [replicate, cosines] = each[i];
    for (std::size_t e = known; e < subject.evenings.size(); ++e)
      *cosines = made_even(*subject.evenings[e], replicate, *cosines);
  });
  return columns;
}

void add_effect(const EffectTerm& term, const Subject& subject, std::size_t replicate,
                const Columns& columns, const Eigen::VectorXd& coefficients, Eigen::VectorXd& to) {
  if (coefficients.size() == 0) return;
  if (term.effect->add != nullptr && subject.evenings.empty()) {
    term.effect->add(term, subject, replicate, coefficients, to);
    return;
  }
  for (Index i = 0; i < coefficients.size(); ++i) {
    const auto column = static_cast<std::size_t>(i);
    if (columns.samples.empty()) {
      to += coefficients(i) * inverse_cosine_transform(columns.cosines[column]);
    } else {
      to += coefficients(i) * columns.samples[column];
    }
  }
}

tl::unexpected<Error> unfit(const EffectTerm& term, const std::string& what) {
  return tl::unexpected(Error{print(term) + ": " + what});
}

tl::unexpected<Error> too_fast(const EffectTerm& term, const Subject& subject) {
  return unfit(term, fmt::format("half the sampling rate is {} Hz", 0.5 * subject.rate.value));
}

Result<void> check(const EffectTerm& term, const Subject& subject) {
  const Effect& effect = *term.effect;
  if (effect.witness && subject.find(term.witness) == nullptr) {
    std::string known;
    for (const Witness& one : subject.witnesses) known += (known.empty() ? "" : ", ") + one.name;
    return unfit(term, known.empty() ? "no other recorded channel changes"
                                     : "no such witness; there are " + known);
  }
  for (std::size_t i = 0; i < term.values.size(); ++i) {
    const EffectParameter& about = effect.parameters[i];
    if (about.truth && term.given(i)) {
      return unfit(term,
                   fmt::format("a fit finds {} itself; leave it out (imunoise simulate takes it)",
                               about.name));
    }
  }
  return effect.check == nullptr ? Result<void>{} : effect.check(term, subject);
}

}  // namespace imunoise
