// Outliers: what they are worth where there are many small ones, and where there are none.

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/effects/distributions/contamination.h"
#include "core/effects/known_effects.h"
#include "core/regression/current.h"
#include "core/support/distributions.h"
#include "core/support/random.h"
#include "tests/core/diagnosis/subject_of.h"

namespace imunoise {
namespace {

// Nats that taking outliers beyond `above` out of white noise gains.
double gain(const std::shared_ptr<const Subject>& subject, double above) {
  const FittedModel base = fitted(subject, "WN");
  const FittedModel with = fit_with(current_of(base.regression, base.fit),
                                    EffectTerm(effect_named("outliers"), "", {{"above", above}}));
  const std::vector<double>& prices = with.regression.subject().own_nats;
  return with.fit.log_likelihood - base.fit.log_likelihood -
         std::accumulate(prices.begin(), prices.end(), 0.0);
}

// Noise passes 3.5 standard deviations 30 times in 65,536 samples, each time a little further: that
// is worth nothing.
TEST(Outliers, NoiseHasNone) {
  const MadeSubject made{.model = "WN(sigma2=1)", .samples = 16'384, .seed = 32};
  EXPECT_LT(gain(subject_of(made), 3.5), 3.0);
}

// A share of the samples with deviations added; what they are worth to an observer who knows the
// mixture that they were drawn from.
struct Disturbed {
  std::shared_ptr<const Subject> subject;
  double known = 0.0;  // nats
};

Disturbed disturbed(double share, double size, std::uint64_t seed) {
  constexpr Eigen::Index kSamples = 16'384;
  RandomStream random(seed);
  std::vector<Eigen::VectorXd> added(4, Eigen::VectorXd::Zero(kSamples));
  for (Eigen::VectorXd& x : added) {
    for (Eigen::Index i = 0; i < std::lround(share * static_cast<double>(kSamples)); ++i)
      x(static_cast<Eigen::Index>(random.engine()() % kSamples)) += size * random.normal();
  }
  MadeSubject made{.model = "WN(sigma2=1)", .samples = kSamples, .seed = seed + 1};
  const double rate = subject_of(made)->rate.value;
  made.added = [&](std::size_t k, double s) { return added[k](std::lround(s * rate)); };
  Disturbed out{subject_of(made)};
  const Contamination truth{share, std::sqrt(1.0 + size * size)};
  double squares = 0.0;
  double samples = 0.0;
  for (std::size_t k = 0; k < added.size(); ++k) {
    const SharedVector& x = out.subject->samples[k];
    for (const double one : x) {
      const double z = one + added[k].mean();  // subjects have the mean 0
      out.known += truth.log_ratio(z) - 0.5 * z * z;
    }
    squares += x.squaredNorm();
    samples += static_cast<double>(x.size());
  }
  out.known += 0.5 * samples * (1.0 + std::log(squares / samples));
  return out;
}

// 0.3 % of the samples with deviations of 5 added: half of them stand out, and together they are
// worth what the mixture is.
TEST(Outliers, ManySmallOnesAreWorthTheirMixture) {
  const Disturbed made = disturbed(0.003, 5.0, 33);
  const double got = gain(made.subject, 4.0);
  EXPECT_GT(got, 0.93 * made.known);
  EXPECT_LT(got, made.known + 5.0);  // its own numbers fit better, by ½ χ²
}

// Strong ones make the noise look louder, and hide the weaker. They gain no less than the mixture;
// a little more, because a rare one costs the same whatever its size.
TEST(Outliers, StrongOnesHideNone) {
  for (const std::uint64_t seed : {35U, 37U, 39U}) {
    const Disturbed made = disturbed(0.003, 200.0, seed);
    EXPECT_GT(gain(made.subject, 4.8), made.known - 15.0) << "seed " << seed;
  }
}

TEST(Contamination, FollowsFromWhatIsBeyondAThreshold) {
  constexpr double kAbove = 4.5;
  const Contamination truth{0.002, 4.0};
  const double a = kAbove / truth.width;
  const double density = 0.3989422804014327 * std::exp(-0.5 * a * a);
  const double square = 16.0 * (1.0 + a * density / normal_tail(a));
  const auto got = contamination_of(1e6 * truth.share * 2.0 * normal_tail(a), 1e6, kAbove, square);
  ASSERT_TRUE(got);
  EXPECT_NEAR(got->share, truth.share, 1e-9);
  EXPECT_NEAR(got->width, truth.width, 1e-6);
  // Where it is as likely one as the other, the density is twice that of the narrow ones.
  const double even = got->even_chance();
  const double narrow = std::log(1.0 - truth.share);
  EXPECT_NEAR(got->log_ratio(even), narrow + std::log(2.0), 1e-9);
  EXPECT_NEAR(got->log_ratio(0.0), std::log(1.0 - truth.share + truth.share / truth.width), 1e-12);
  // No wider than noise: 20.25 + 1.9 is what normal numbers have there.
  EXPECT_FALSE(contamination_of(100.0, 1e6, kAbove, kAbove * kAbove + 1.5));
}

}  // namespace
}  // namespace imunoise
