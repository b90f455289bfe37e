#include "core/diagnosis/columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <utility>

#include "core/diagnosis/shapes.h"
#include "core/spectrum/cosine_transform.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

// The movements of a transformed series between two frequencies, in Hz.
void keep_between(Eigen::VectorXd& cosines, double from, double to, double rate) {
  const auto per_hertz = 2.0 * static_cast<double>(cosines.size() + 1) / rate;
  const auto n = static_cast<double>(cosines.size());
  const auto first = static_cast<Index>(std::min(from * per_hertz, n));
  const auto last = static_cast<Index>(std::min(to * per_hertz, n));
  cosines.head(first).setZero();
  cosines.tail(cosines.size() - last).setZero();
}

bool as_it_is(const EffectTerm& term) {
  return !term.quadratic && !term.derivative && !(term.lag > 0.0);
}

bool in_part_of_the_frequencies(const EffectTerm& term) {
  return term.from > 0.0 || std::isfinite(term.to);
}

// The witness as the term takes it: behind its lag, squared, its change.
SharedVector witness_samples(const EffectTerm& term, const Witness& witness, std::size_t k,
                             double rate) {
  if (as_it_is(term)) return witness.samples[k];
  Eigen::VectorXd x = term.lag > 0.0 ? lagged(witness.samples[k], term.lag * rate)
                                     : Eigen::VectorXd(witness.samples[k]);
  if (term.quadratic) x = x.array().square();
  if (term.derivative) x = rate_of_change(x, rate);
  return x;
}

// A single column; all frequencies are the samples' own.
Columns witness_columns(const EffectTerm& term, const Witness& witness, std::size_t k,
                        double rate) {
  const SharedVector samples = witness_samples(term, witness, k, rate);
  const SharedVector cosines =
      as_it_is(term) ? witness.cosines[k] : SharedVector(cosine_transform(samples));
  if (!in_part_of_the_frequencies(term)) return {{cosines}, {}, {samples}};
  Eigen::VectorXd part = cosines;
  keep_between(part, term.from, term.to, rate);
  return {{std::move(part)}, {}, {}};
}

// The form that an effect has from a sample of what was recorded on.
Shape shape_of(const EffectTerm& term, double rate, Index first) {
  switch (term.kind) {
    case EffectKind::kRamp:
      return ramp(rate);
    case EffectKind::kWarmUp:
      return warm_up(term.tau * rate, first);
    case EffectKind::kLine:
      return waves(term.frequency / rate, static_cast<int>(term.harmonics));
    default:
      assert(term.kind == EffectKind::kStep);
      return step(std::lround(term.time * rate) - first);
  }
}

// The replicate that a step is in.
std::optional<std::size_t> stepping(const EffectTerm& term, const Subject& subject) {
  return subject.around(static_cast<std::size_t>(term.replicate) - 1,
                        std::lround(term.time * subject.rate.value));
}

// The columns of a matrix, which they share.
std::vector<SharedVector> columns_of(Eigen::MatrixXd matrix) {
  const auto shared = std::make_shared<const Eigen::MatrixXd>(std::move(matrix));
  std::vector<SharedVector> out;
  for (Index i = 0; i < shared->cols(); ++i)
    out.emplace_back(shared, shared->col(i).data(), shared->rows());
  return out;
}

// Regressors that every replicate has: one set of coefficients, or one a replicate.
template <class ColumnsIn>
Regressors in_all(const Subject& subject, bool own, const std::vector<std::string>& names,
                  const ColumnsIn& columns_in) {
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

// Effects of known form: replicates of one length that begin alike share their columns.
Regressors shaped(const EffectTerm& term, const Subject& subject, bool own,
                  const std::vector<std::string>& names) {
  const auto key = [&](std::size_t k) {
    return std::pair(subject.length(k), subject.parts[k].first);
  };
  std::map<std::pair<Index, Index>, std::vector<SharedVector>> made;
  for (std::size_t k = 0; k < subject.replicates(); ++k) made[key(k)];
  std::vector<decltype(made)::iterator> each;
  for (auto one = made.begin(); one != made.end(); ++one) each.push_back(one);
  for_each_index(each.size(), [&](std::size_t i) {
    const auto [length, first] = each[i]->first;
    each[i]->second = columns_of(shape_of(term, subject.rate.value, first).cosines(length));
  });
  return in_all(subject, own, names, [&](std::size_t k) {
    return Columns{made.at(key(k)), {}, {}};
  });
}

std::vector<std::string> wave_names(int harmonics) {
  std::vector<std::string> out;
  for (int h = 1; h <= harmonics; ++h) {
    out.push_back(fmt::format("cosine_{}", h));
    out.push_back(fmt::format("sine_{}", h));
  }
  return out;
}

}  // namespace

Eigen::VectorXd lagged(const VectorRef& x, double lag) {
  const double keep = std::exp(-1.0 / lag);
  Eigen::VectorXd out(x.size());
  double state = x.size() > 0 ? x(0) : 0.0;
  for (Index t = 0; t < x.size(); ++t) {
    state = keep * state + (1.0 - keep) * x(t);
    out(t) = state;
  }
  return out;
}

Eigen::VectorXd rate_of_change(const VectorRef& x, double rate) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(x.size());
  out.tail(x.size() - 1) = rate * (x.tail(x.size() - 1) - x.head(x.size() - 1));
  return out;
}

Regressors regressors_of(const EffectTerm& term, const Subject& subject) {
  switch (term.kind) {
    case EffectKind::kRamp:
      return shaped(term, subject, term.own, {"slope"});
    case EffectKind::kWarmUp:
      return shaped(term, subject, term.own, {"amplitude"});
    case EffectKind::kLine:
      return shaped(term, subject, true, wave_names(static_cast<int>(term.harmonics)));
    case EffectKind::kStep: {
      Regressors out{std::vector<Columns>(subject.replicates()), {}};
      const std::size_t k = *stepping(term, subject);
      const Shape shape = shape_of(term, subject.rate.value, subject.parts[k].first);
      out.replicates[k] = {columns_of(shape.cosines(subject.length(k))), {0}, {}};
      out.coefficients.push_back({"height", k});
      return out;
    }
    case EffectKind::kWitness: {
      const Witness& witness = *subject.find(term.witness);
      return in_all(
          subject, term.own, {term.quadratic ? "quadratic_coefficient" : "coefficient"},
          [&](std::size_t k) { return witness_columns(term, witness, k, subject.rate.value); });
    }
    case EffectKind::kTelegraph:
      if (subject.courses.empty()) break;  // not sought yet
      return in_all(subject, false, {"height"}, [&](std::size_t k) {
        return Columns{{subject.courses[k].cosines}, {}, {}};
      });
    case EffectKind::kModulated:
    case EffectKind::kOutliers:
    case EffectKind::kOwnPowers:
      break;
  }
  return {std::vector<Columns>(subject.replicates()), {}};
}

void add_effect(const EffectTerm& term, const Subject& subject, std::size_t replicate,
                const Columns& columns, const Eigen::VectorXd& coefficients, Eigen::VectorXd& to) {
  if (coefficients.size() == 0) return;
  switch (term.kind) {
    case EffectKind::kRamp:
    case EffectKind::kWarmUp:
    case EffectKind::kLine:
    case EffectKind::kStep:
      shape_of(term, subject.rate.value, subject.parts[replicate].first).add(coefficients, to);
      return;
    case EffectKind::kWitness:
    case EffectKind::kTelegraph:
    case EffectKind::kModulated:
    case EffectKind::kOutliers:
    case EffectKind::kOwnPowers:
      break;
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

Result<void> check(const EffectTerm& term, const Subject& subject) {
  const auto wrong = [&](const std::string& what) -> Result<void> {
    return tl::unexpected(Error{print(term) + ": " + what});
  };
  if (!term.witness.empty() && subject.find(term.witness) == nullptr) {
    std::string known;
    for (const Witness& one : subject.witnesses) known += (known.empty() ? "" : ", ") + one.name;
    return wrong(known.empty() ? "no channel was recorded beside this one that changes"
                               : "no such witness; there are " + known);
  }
  if (term.kind == EffectKind::kStep) {
    const std::size_t recorded = subject.parts.back().recorded + 1;
    if (term.replicate > static_cast<double>(recorded))
      return wrong(fmt::format("there are only {} replicates", recorded));
    if (!stepping(term, subject)) return wrong("nothing of the replicate is used around that time");
  }
  const double fastest = 0.5 * subject.rate.value;
  if (term.frequency * term.harmonics > fastest || term.from >= fastest)
    return wrong(fmt::format("half the sampling rate is {} Hz", fastest));
  double longest = 0.0;  // s
  for (std::size_t k = 0; k < subject.replicates(); ++k)
    longest = std::max(longest, subject.seconds(k));
  if (term.kind == EffectKind::kLine && term.frequency * longest < 0.5)
    return wrong(fmt::format("no replicate is as long as half a period ({:.6g} s)", longest));
  if (term.kind == EffectKind::kWarmUp && term.tau * subject.rate.value < 1.0)
    return wrong("tau is shorter than a sample");
  return {};
}

}  // namespace imunoise
