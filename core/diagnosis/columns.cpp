#include "core/diagnosis/columns.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "core/spectrum/cosine_transform.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

Eigen::VectorXd ramp(Index n, double rate) {
  return Eigen::VectorXd::LinSpaced(n, 0.0, static_cast<double>(n - 1) / rate);
}

Eigen::VectorXd warm_up(Index n, double tau_samples) {
  return (-Eigen::ArrayXd::LinSpaced(n, 0.0, static_cast<double>(n - 1)) / tau_samples).exp();
}

Eigen::VectorXd step(Index n, Index at) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(n);
  if (at < n) out.tail(n - at).setOnes();
  return out;
}

// The cosine and sine of each multiple of a frequency, side by side.
Eigen::MatrixXd waves(Index n, double cycles_per_sample, int harmonics) {
  Eigen::MatrixXd out(n, 2 * harmonics);
  const Eigen::ArrayXd t = Eigen::ArrayXd::LinSpaced(n, 0.0, static_cast<double>(n - 1));
  for (int h = 0; h < harmonics; ++h) {
    const Eigen::ArrayXd angle = (2.0 * std::numbers::pi * (h + 1) * cycles_per_sample) * t;
    out.col(2 * h) = angle.cos();
    out.col(2 * h + 1) = angle.sin();
  }
  return out;
}

Eigen::MatrixXd transformed(const Eigen::MatrixXd& samples) {
  Eigen::MatrixXd out(samples.rows() - 1, samples.cols());
  for (Index i = 0; i < samples.cols(); ++i) out.col(i) = cosine_transform(samples.col(i));
  return out;
}

// The movements of a transformed series between two frequencies, in Hz.
void keep_between(Eigen::VectorXd& cosines, double from, double to, double rate) {
  const auto per_hertz = 2.0 * static_cast<double>(cosines.size() + 1) / rate;
  const auto n = static_cast<double>(cosines.size());
  const auto first = static_cast<Index>(std::min(from * per_hertz, n));
  const auto last = static_cast<Index>(std::min(to * per_hertz, n));
  cosines.head(first).setZero();
  cosines.tail(cosines.size() - last).setZero();
}

Eigen::MatrixXd witness_cosines(const EffectTerm& term, const Witness& witness, std::size_t k,
                                double rate) {
  Eigen::VectorXd cosines = witness.cosines[k];
  if (term.quadratic || term.derivative || term.lag > 0.0) {
    Eigen::VectorXd x = witness.samples[k];
    if (term.lag > 0.0) x = lagged(x, term.lag * rate);
    if (term.quadratic) x = x.array().square();
    if (term.derivative) x = rate_of_change(x, rate);
    cosines = cosine_transform(x);
  }
  keep_between(cosines, term.from, term.to, rate);
  return cosines;
}

// Regressors that every replicate has: one set of coefficients, or one a replicate.
template <class CosinesOf>
Regressors in_all(const Subject& subject, bool own, const std::vector<std::string>& names,
                  const CosinesOf& cosines_of) {
  Regressors out;
  const auto q = static_cast<Index>(names.size());
  for (std::size_t k = 0; k < subject.replicates(); ++k) {
    Columns one{cosines_of(k), {}};
    for (Index i = 0; i < q; ++i) one.places.push_back(i + (own ? static_cast<Index>(k) * q : 0));
    out.replicates.push_back(std::move(one));
    if (k > 0 && !own) continue;
    for (const std::string& name : names)
      out.coefficients.push_back({name, own ? k : CoefficientName::kAll});
  }
  return out;
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
  const double rate = subject.rate.value;
  switch (term.kind) {
    case EffectKind::kRamp:
      return in_all(subject, term.own, {"slope"},
                    [&](std::size_t k) { return transformed(ramp(subject.length(k), rate)); });
    case EffectKind::kWarmUp:
      return in_all(subject, term.own, {"amplitude"}, [&](std::size_t k) {
        return transformed(warm_up(subject.length(k), term.tau * rate));
      });
    case EffectKind::kLine: {
      const auto harmonics = static_cast<int>(term.harmonics);
      return in_all(subject, true, wave_names(harmonics), [&](std::size_t k) {
        return transformed(waves(subject.length(k), term.frequency / rate, harmonics));
      });
    }
    case EffectKind::kStep: {
      Regressors out{std::vector<Columns>(subject.replicates()), {}};
      const auto k = static_cast<std::size_t>(term.replicate) - 1;
      for (std::size_t i = 0; i < subject.replicates(); ++i)
        out.replicates[i].cosines.resize(subject.length(i) - 1, 0);
      const auto at = static_cast<Index>(std::lround(term.time * rate));
      out.replicates[k] = {transformed(step(subject.length(k), at)), {0}};
      out.coefficients.push_back({"height", k});
      return out;
    }
    case EffectKind::kWitness: {
      const Witness& witness = *subject.find(term.witness);
      return in_all(subject, term.own, {term.quadratic ? "quadratic_coefficient" : "coefficient"},
                    [&](std::size_t k) { return witness_cosines(term, witness, k, rate); });
    }
    case EffectKind::kTelegraph:
      if (subject.courses.empty()) break;  // not sought yet
      return in_all(subject, false, {"height"},
                    [&](std::size_t k) { return subject.courses[k].cosines; });
    case EffectKind::kModulated:
    case EffectKind::kOutliers:
    case EffectKind::kOwnPowers:
      break;
  }
  Regressors none{std::vector<Columns>(subject.replicates()), {}};
  for (std::size_t i = 0; i < subject.replicates(); ++i)
    none.replicates[i].cosines.resize(subject.length(i) - 1, 0);
  return none;
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
    if (term.replicate > static_cast<double>(subject.replicates()))
      return wrong(fmt::format("there are only {} replicates", subject.replicates()));
    if (term.time >= subject.seconds(static_cast<std::size_t>(term.replicate) - 1))
      return wrong("the replicate ends before");
  }
  if (term.frequency * term.harmonics > 0.5 * subject.rate.value)
    return wrong(fmt::format("half the sampling rate is {} Hz", 0.5 * subject.rate.value));
  return {};
}

}  // namespace imunoise
