#include "core/diagnosis/placebo.h"

#include <algorithm>
#include <cmath>

#include "core/diagnosis/candidates.h"
#include "core/effect/columns.h"
#include "core/search/evidence.h"
#include "core/spectrum/cosine_transform.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

constexpr std::size_t kMostPlacebos = 12;  // terms that are tested
constexpr double kAsMuch = 3.0;            // nats: less cannot tell two courses apart

// Sums of products of a whitened regressor a and what is left, r.
struct PlaceboSums {
  double aa = 0.0;
  double ar = 0.0;
  double aaaa = 0.0;
  double aaar = 0.0;
  double aarr = 0.0;

  void add(const Eigen::ArrayXd& a, const Eigen::ArrayXd& r) {
    const Eigen::ArrayXd square = a.square();
    aa += square.sum();
    ar += (a * r).sum();
    aaaa += square.square().sum();
    aaar += (square * a * r).sum();
    aarr += (square * r.square()).sum();
  }
  void add(const PlaceboSums& more) {
    aa += more.aa;
    ar += more.ar;
    aaaa += more.aaaa;
    aaar += more.aaar;
    aarr += more.aarr;
  }
  double dof() const { return aa * aa / aaaa; }
  // Variance of the score by its scatter once the regressor is fitted, over that by the model.
  double inflation() const {
    const double b = ar / aa;
    return (aarr - 2.0 * b * aaar + b * b * aaaa) / aa;
  }
};

// What a regressor that all replicates share adds to each, up to a factor: its columns with the
// coefficients that were fitted. Empty where it is not of this kind.
std::vector<SharedVector> shared_column(const TriedTerm& tried, const Subject& subject) {
  const EffectTerm& term = *tried.term();
  if (term.effect->regressors == nullptr || term.effect->fit_with != nullptr) return {};
  const Regressors made = regressors_of(term, subject);
  const std::size_t count = made.coefficients.size();
  const bool shared = std::all_of(
      made.coefficients.begin(), made.coefficients.end(),
      [](const CoefficientName& one) { return one.replicate == CoefficientName::kAll; });
  if (count == 0 || !shared) return {};
  const Regression& regression = tried.fitted.regression;
  const Eigen::VectorXd& all = tried.fitted.fit.effects.value;
  const Eigen::VectorXd fitted =
      all.segment(regression.first(regression.effects().size() - 1), static_cast<Index>(count));
  std::vector<SharedVector> out;
  for (const Columns& one : made.replicates) {
    if (one.cosines.size() != count) return {};
    if (count == 1) {
      out.push_back(one.cosines[0]);
      continue;
    }
    Eigen::VectorXd sum = fitted(0) * one.cosines[0];
    for (std::size_t i = 1; i < count; ++i) sum += fitted(static_cast<Index>(i)) * one.cosines[i];
    out.emplace_back(std::move(sum));
  }
  return out;
}

// The first `extent` samples of a column in a replicate of so many samples; then it stays as it is,
// as a step would hide what slow noise lets it explain.
SharedVector within(const SharedVector& cosines, Index extent, Index samples) {
  if (cosines.size() + 1 == samples && extent == samples) return cosines;
  const Eigen::VectorXd all = inverse_cosine_transform(cosines);
  Eigen::VectorXd out = Eigen::VectorXd::Constant(samples, all(extent - 1));
  out.head(extent) = all.head(extent);
  return cosine_transform(out);
}

// Of all replicates.
PlaceboSums sums_of(const Current& current, const std::vector<SharedVector>& columns) {
  std::vector<PlaceboSums> each(columns.size());
  for_each_index(columns.size(), [&](std::size_t k) {
    const Eigen::ArrayXd deviation = current.spectrum[k].sqrt();
    each[k].add(columns[k].array() / deviation, current.cosines[k].array() / deviation);
  });
  PlaceboSums out;
  for (const PlaceboSums& one : each) out.add(one);
  return out;
}

// What a regressor explains of what is left of a replicate.
struct Explained {
  double product = 0.0;
  double square = 0.0;

  Explained() = default;
  Explained(const Current& current, std::size_t k, const SharedVector& column)
      : product((column.array() * current.cosines[k].array() / current.spectrum[k]).sum()),
        square((column.array().square() / current.spectrum[k]).sum()) {}
  void add(const Explained& more) {
    product += more.product;
    square += more.square;
  }
  double gain() const { return square > 0.0 ? 0.5 * product * product / square : 0.0; }
  /// Nothing where the coefficient has the other sign: what is common moves the same way.
  double gain_with(const Explained& own) const {
    return product * own.product > 0.0 ? gain() : 0.0;
  }
};

// Does the column of the replicate `shift` further on explain as much as each replicate's own, over
// the time that both have?
bool copies_explain_as_much(const Current& current, const std::vector<SharedVector>& columns,
                            std::size_t shift) {
  std::vector<Explained> own(columns.size());
  std::vector<Explained> copied(columns.size());
  for_each_index(columns.size(), [&](std::size_t k) {
    const SharedVector& other = columns[(k + shift) % columns.size()];
    const Index n = columns[k].size() + 1;
    const Index extent = std::min(n, other.size() + 1);
    own[k] = {current, k, within(columns[k], extent, n)};
    copied[k] = {current, k, within(other, extent, n)};
  });
  Explained all_own;
  Explained all_copied;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    all_own.add(own[k]);
    all_copied.add(copied[k]);
  }
  return all_copied.gain_with(all_own) > all_own.gain() - kAsMuch;
}

// A first look at what copies explain, without a transform a pair: products in time, squares as if
// columns were everywhere as they are on average.
class Glance {
 public:
  Glance(const Current& current, const std::vector<SharedVector>& columns)
      : current_(current), samples_(columns.size()), square_(columns.size()) {
    for_each_index(columns.size(), [&](std::size_t k) {
      samples_[k] = inverse_cosine_transform(columns[k]);
      const double all = (columns[k].array().square() / current.spectrum[k]).sum();
      square_[k] = all / static_cast<double>(samples_[k].size());
    });
  }

  /// Whether the copies of this shift may explain as much as the columns themselves: a tenth.
  bool may_explain_as_much(std::size_t shift) const {
    constexpr double kTenth = 0.1;
    const std::size_t count = samples_.size();
    Explained own;
    Explained copied;
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t other = (k + shift) % count;
      const Index extent = std::min(samples_[k].size(), samples_[other].size());
      own.add(explained(k, k, extent));
      copied.add(explained(k, other, extent));
    }
    return copied.gain_with(own) > kTenth * own.gain() - kAsMuch;
  }

 private:
  Explained explained(std::size_t k, std::size_t column, Index extent) const {
    const auto of = samples_[column].head(extent);
    const Eigen::VectorXd& left = current_.weighted[k];
    Explained out;
    out.product =
        of.dot(left.head(extent)) + of(extent - 1) * left.tail(left.size() - extent).sum();
    out.square = square_[column] * static_cast<double>(extent);
    return out;
  }

  const Current& current_;
  std::vector<Eigen::VectorXd> samples_;
  std::vector<double> square_;  // of whitened columns, a sample
};

bool copies_explain_as_much(const Current& current, const std::vector<SharedVector>& columns) {
  const Glance glance(current, columns);
  for (std::size_t shift = 1; shift < columns.size(); ++shift) {
    if (glance.may_explain_as_much(shift) && copies_explain_as_much(current, columns, shift))
      return true;
  }
  return false;
}

void test_placebo(TriedTerm& tried, const Current& current, Placebos which) {
  const Subject& subject = current.subject();
  const std::vector<SharedVector> columns = shared_column(tried, subject);
  if (columns.empty()) return;
  const PlaceboSums own = sums_of(current, columns);
  if (!(own.aa > 0.0)) return;
  const bool several = subject.parts.back().recorded > 0;
  if (which == Placebos::kAll && several && copies_explain_as_much(current, columns))
    tried.could_be.push_back("common_course");
  constexpr double kBeyondChance = 3.0;  // standard deviations
  const double dof = own.dof();
  const double inflation = own.inflation();
  if (!(inflation > 1.0 + kBeyondChance * std::sqrt(2.0 / dof))) return;
  Suggestion& how = tried.suggestion;
  how.inflation *= inflation;
  tried.noise_dof = std::min(tried.noise_dof, std::max(1.0, dof - 1.0));
  tried.log_p = log_p_value(tried.likelihood_gain / how.inflation, how.dof, tried.noise_dof,
                            how.power, how.search);
  tried.gain = -tried.log_p;
}

}  // namespace

void test_placebos(std::vector<TriedTerm>& tried, const Current& current, double least,
                   Placebos which, const Progress& progress) {
  std::size_t tested = 0;
  for (TriedTerm& one : tried) {
    if (tested == kMostPlacebos || !(one.log_p < least) || progress.stopped()) break;
    if (one.term() == nullptr || one.term()->effect->regressors == nullptr) continue;
    test_placebo(one, current, which);
    ++tested;
  }
  best_first(tried);
}

}  // namespace imunoise
