// The closed forms of the averaging filters against sums over their taps.

#include "core/process/averaging_filters.h"

#include <gtest/gtest.h>

#include "core/process/moving_average.h"

namespace imunoise {
namespace {

template <class Filter>
void expect_closed_forms(int n) {
  SCOPED_TRACE(std::string(Filter::kInfo.name) + "(" + std::to_string(n) + ")");
  const Filter filter{2.5, n};
  const FiniteMemory closed = filter.filter();
  const FiniteMemory summed(closed.taps());
  ASSERT_EQ(closed.autocovariance().size(), summed.autocovariance().size());
  for (std::size_t h = 0; h < closed.autocovariance().size(); ++h) {
    EXPECT_NEAR(closed.autocovariance()[h], summed.autocovariance()[h], 1e-13 / n) << "lag " << h;
  }
  // The same taps as a moving average, whose spectrum is the square of their sum.
  MovingAverage moving{2.5 * closed.taps()[0] * closed.taps()[0], {}};
  for (std::size_t k = 1; k < closed.taps().size(); ++k)
    moving.theta.push_back(closed.taps()[k] / closed.taps()[0]);
  for (const double f : {-0.5, -0.21, 0.0, 1e-12, 1e-6, 1.0 / n, 0.7 / n, 0.25, 0.4999, 0.5}) {
    EXPECT_NEAR(filter.spectrum(f), moving.spectrum(f), 1e-12) << "f = " << f;
  }
}

TEST(AveragingFilters, ClosedFormsAreTheSums) {
  for (const int n : {1, 2, 3, 7, 64, 500}) {
    expect_closed_forms<MovingAverageFilter>(n);
    expect_closed_forms<BartlettFilter>(n);
  }
}

}  // namespace
}  // namespace imunoise
