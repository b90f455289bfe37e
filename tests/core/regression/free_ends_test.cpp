// Noise of finite memory: ends that a cosine transform takes for something else.

#include "core/regression/free_ends.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/spectrum/cosine_transform.h"
#include "tests/core/diagnosis/subject_of.h"

namespace imunoise {
namespace {

Model noise_of(const std::string& text) { return *parse_model(text, Hertz{50.0}); }

TEST(FreeEnds, AreHalfOfTheFilter) {
  EXPECT_EQ(free_ends(noise_of("WN + RW")), 0);
  EXPECT_EQ(free_ends(noise_of("MAVG(4) + RW")), 2);
  EXPECT_EQ(free_ends(noise_of("MAVG(5) + RW")), 2);
  EXPECT_EQ(free_ends(noise_of("BARTLETT(4) + RW")), 3);
  EXPECT_EQ(free_ends(noise_of("MA")), 1);
}

// The whitened samples of the true model are white: none stands out, at the ends or elsewhere.
TEST(FreeEnds, WhatIsLeftIsWhite) {
  for (const std::uint64_t seed : {61U, 62U, 63U}) {
    const std::string truth = "MAVG(4, sigma2=1) + RW(gamma2=1e-6)";
    const FittedModel fit =
        fit_full_model(subject_of({.model = truth, .samples = 16'384, .seed = seed}),
                       *parse_full_model(truth, Hertz{50.0}));
    for (const Eigen::VectorXd& white : innovations(fit.regression, fit.fit).white)
      EXPECT_LT(white.cwiseAbs().maxCoeff(), 5.2) << "seed " << seed;  // once in 80 sets
  }
}

TEST(FreeEnds, ATrueFilterMissesNothing) {
  for (const std::string filter : {"MAVG(4)", "MAVG(5)", "BARTLETT(3)"}) {
    const std::string walk = filter == "MAVG(5)" ? " + RW(gamma2=1e-4)" : " + RW(gamma2=1e-6)";
    const FittedModel fit = fit_full_model(
        subject_of(
            {.model = filter.substr(0, filter.size() - 1) + ", sigma2=1)" + walk, .seed = 64}),
        *parse_full_model(filter + walk, Hertz{50.0}));
    const Diagnosis found = diagnose(fit);
    EXPECT_GT(found.effects.front().familywise_p, 0.01)
        << filter << ": " << found.effects.front().tried.cause;
  }
}

}  // namespace
}  // namespace imunoise
