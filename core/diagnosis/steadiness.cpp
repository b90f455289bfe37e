#include "core/diagnosis/steadiness.h"

#include <cmath>

#include "core/diagnosis/views/normal_power.h"
#include "core/spectrum/cosine_transform.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

constexpr Index kMostStretches = 16;
constexpr double kFewestOfAReplicate = 8.0;

// The term of the fitted model that is of the added kind and follows it best: the last of them.
const Term* term_like(const Model& noise, const Process& added) {
  const Term* out = nullptr;
  for (const Term& term : noise.terms) {
    if (term.process.index() == added.index()) out = &term;
  }
  return out;
}

}  // namespace

TestOutcome steadiness(const Regression& regression, const JointFit& fit, const Process& added) {
  const Term* term = term_like(fit.model.noise, added);
  if (term == nullptr) return {};
  const Model alone{{*term}};
  double chi = 0.0;
  Index dof = 0;
  for (std::size_t k = 0; k < regression.subject().replicates(); ++k) {
    const Eigen::VectorXd left = regression.residual_cosines(fit.effects.value, k);
    const Index n = left.size() + 1;
    const Eigen::ArrayXd spectrum = spectrum_of_cosines(fit.model.noise, n);
    const Eigen::ArrayXd share = spectrum_of_cosines(alone, n) / spectrum;
    // Power of the course, were it white in its band: Σ share numbers of variance 1, which are
    // worth (Σ share)²/Σ share² degrees of dof.
    const Eigen::VectorXd course =
        inverse_cosine_transform((left.array() * (share / spectrum).sqrt()).matrix());
    const double worth = share.sum() * share.sum() / share.square().sum();
    const auto stretches =
        std::min(kMostStretches, static_cast<Index>(worth / kFewestOfAReplicate));
    if (stretches < 2) continue;
    const Index length = n / stretches;
    const double mean = course.squaredNorm() / static_cast<double>(n);
    for (Index i = 0; i < stretches; ++i) {
      const double ratio =
          course.segment(i * length, length).squaredNorm() / (static_cast<double>(length) * mean);
      const double score = normal_score(ratio, worth / static_cast<double>(stretches));
      chi += score * score;
    }
    dof += stretches - 1;
  }
  return chi_square_test(chi, dof);
}

bool made_of_lines(const Regression& regression, const JointFit& fit, const Process& added) {
  constexpr double kMost = 0.5;       // of the power
  constexpr double kFewest = 8.0;     // coefficients
  constexpr double kClearly = 6.0;    // standard errors
  constexpr double kVariance = 96.0;  // of the square of χ² with one degree of freedom
  const Term* term = term_like(fit.model.noise, added);
  if (term == nullptr) return false;
  const Model alone{{*term}};
  double count = 0.0;
  double sum = 0.0;
  for (std::size_t k = 0; k < regression.subject().replicates(); ++k) {
    const Eigen::ArrayXd left = regression.residual_cosines(fit.effects.value, k).array();
    const Eigen::ArrayXd spectrum = spectrum_of_cosines(fit.model.noise, left.size() + 1);
    const Eigen::ArrayXd own = spectrum_of_cosines(alone, left.size() + 1);
    const Eigen::ArrayXd within = (own > kMost * spectrum).cast<double>();
    count += within.sum();
    sum += (within * (left.square() / spectrum).square()).sum();
  }
  return count >= kFewest && sum / count > 3.0 + kClearly * std::sqrt(kVariance / count);
}

}  // namespace imunoise
