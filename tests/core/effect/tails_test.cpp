// Student's law and a mixture are told apart where the data can, and never by a single sample.

#include "core/effects/distributions/tails.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iostream>

#include "core/effects/draws.h"

namespace imunoise {
namespace {

constexpr std::size_t kTailSamples = 32'768;

TailComparison compared(std::uint64_t seed, const std::function<double(RandomStream&)>& draw) {
  RandomStream random(seed);
  Eigen::VectorXd white(kTailSamples);
  for (double& x : white) x = draw(random);
  return compare_tails(count_sizes({white}));
}

TEST(Tails, OfStudentAreNoMixture) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const TailComparison found =
        compared(seed, [](RandomStream& random) { return student_number(4.0, random); });
    EXPECT_TRUE(found.rules_out_mixture())
        << "seed " << seed << ": " << found.student - found.mixture;
    EXPECT_FALSE(found.rules_out_student());
  }
}

TEST(Tails, OfAMixtureAreNotStudents) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const TailComparison found = compared(seed, [](RandomStream& random) {
      return (uniform_number(random) < 0.02 ? 4.0 : 1.0) * random.normal();
    });
    EXPECT_TRUE(found.rules_out_student())
        << "seed " << seed << ": " << found.student - found.mixture;
    EXPECT_FALSE(found.rules_out_mixture());
  }
}

// Laws that lie between the two, and weak ones: the right one is ruled out with a chance of 1 in
// 700, in more than two of 60 with one of 1 in 10,000.
TEST(Tails, AreSeldomTakenForTheOther) {
  int wrong = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    wrong += compared(
                 seed,
                 [](RandomStream& random) {
                   return random.normal() + 0.5 * student_number(4.0, random);
                 }).rules_out_student()
                 ? 1
                 : 0;
    wrong += compared(
                 seed,
                 [](RandomStream& random) {
                   const double disturbed = uniform_number(random) < 0.002 ? 4.0 : 0.0;
                   return random.normal() + std::copysign(disturbed, random.normal());
                 }).rules_out_mixture()
                 ? 1
                 : 0;
  }
  std::cout << "seeds 1 to 30: " << wrong << " of 60 wrong\n";
  EXPECT_LE(wrong, 2);
}

// Student's distribution explains little of a single sample far out.
TEST(Tails, OfOneFarSampleAreAnOutlier) {
  bool first = true;
  const TailComparison found = compared(7, [&](RandomStream& random) {
    return std::exchange(first, false) ? 12.0 : random.normal();
  });
  EXPECT_TRUE(found.rules_out_student());
  EXPECT_FALSE(found.rules_out_mixture());
}

}  // namespace
}  // namespace imunoise
