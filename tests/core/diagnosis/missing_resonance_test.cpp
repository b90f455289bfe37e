// Peaks of the spectrum: found by a fit that begins anywhere, and of the form that they have.

#include "core/diagnosis/missing_resonance.h"

#include <gtest/gtest.h>

#include "tests/core/diagnosis/subject_of.h"

namespace imunoise {
namespace {

constexpr std::size_t kLong = 32'768;

template <class P>
const P* found_in(const FittedModel& fitted) {
  for (const Term& term : fitted.fit.model.noise.terms) {
    if (const P* const one = std::get_if<P>(&term.process)) return one;
  }
  return nullptr;
}

// Begun at another frequency, a fit stays there: that is what the moments suggest of a faint peak.
TEST(FitWithResonances, FindsAPeakWhereverItBegins) {
  const auto subject =
      subject_of({.model = "WN(sigma2=1) + RW(gamma2=1e-5) + RES(sigma2=2e-3, r=0.98, omega=2)",
                  .samples = kLong,
                  .seed = 51});
  FullModel start = *parse_full_model("WN + RW + RES", subject->rate);
  set_values(start.noise.terms[0].process, std::vector<double>{1.0});
  set_values(start.noise.terms[1].process, std::vector<double>{1e-5});
  set_values(start.noise.terms[2].process, std::vector<double>{1e-3, 0.6, 0.4});
  const FittedModel there = fit_full_model(subject, start);
  const FittedModel sought = fit_with_resonances(subject, start);
  EXPECT_GT(sought.fit.log_likelihood, there.fit.log_likelihood + 20.0);
  ASSERT_NE(found_in<Resonance>(sought), nullptr);
  EXPECT_NEAR(found_in<Resonance>(sought)->omega, 2.0, 0.02);
}

// The best peak has a width that the typed form lacks: this once read a model after it was moved.
TEST(FitWithResonances, KeepsTheFormThatIsAskedFor) {
  const auto subject =
      subject_of({.model = "WN(sigma2=1) + VOIGT(sigma2=0.02, r=0.98, omega=1.2, spread=0.05)",
                  .samples = kLong,
                  .seed = 53});
  FullModel start = *parse_full_model("WN + RES", subject->rate);
  set_values(start.noise.terms[0].process, std::vector<double>{1.0});
  set_values(start.noise.terms[1].process, std::vector<double>{1e-3, 0.6, 0.4});
  const FittedModel sought = fit_with_resonances(subject, start);
  ASSERT_NE(found_in<Resonance>(sought), nullptr);
  EXPECT_EQ(found_in<Voigt>(sought), nullptr);
  EXPECT_NEAR(found_in<Resonance>(sought)->omega, 1.2, 0.05);
}

Suggestion best_peak(const char* model, std::uint64_t seed) {
  const FittedModel plain =
      fitted(subject_of({.model = model, .samples = kLong, .seed = seed}), "WN");
  const Current current = current_of(plain.regression, plain.fit);
  return search_resonances(current, ScoreSpace(current)).front();
}

TEST(SearchResonances, GiveAPeakTheFormThatItHas) {
  const Suggestion sharp = best_peak("WN(sigma2=1) + RES(sigma2=0.02, r=0.95, omega=1.2)", 52);
  EXPECT_TRUE(std::holds_alternative<Resonance>(std::get<NoiseChange>(sharp.added).added));
  const Suggestion broad =
      best_peak("WN(sigma2=1) + VOIGT(sigma2=0.02, r=0.98, omega=1.2, spread=0.05)", 53);
  const auto* const found = std::get_if<Voigt>(&std::get<NoiseChange>(broad.added).added);
  ASSERT_NE(found, nullptr);
  EXPECT_NEAR(found->omega, 1.2, 0.02);
  EXPECT_NEAR(found->spread, 0.05, 0.02);
}

}  // namespace
}  // namespace imunoise
