// Each lane is what one transform alone gives, bit for bit, whatever the processor.

#include "core/spectrum/many_transforms.h"

#include <gtest/gtest.h>

#include <complex>
#include <random>
#include <unsupported/Eigen/FFT>
#include <vector>

namespace imunoise {
namespace {

template <class Number>
using Transforms = void (*)(const Row<Number>*, std::size_t, bool, Row<Number>*);

template <class Number>
void expect_single_transforms(Transforms<Number> many, std::size_t n, bool inverse) {
  constexpr std::size_t kLanes = Row<Number>::kLanes;
  std::mt19937 random(static_cast<unsigned>(n));
  std::vector<Row<Number>> from(2 * n);
  std::vector<Row<Number>> to(2 * n);
  for (Row<Number>& row : from) {
    for (Number& x : row.lanes) x = static_cast<Number>(random()) / Number{1e9};
  }
  many(from.data(), n, inverse, to.data());
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    std::vector<std::complex<Number>> x(n);
    for (std::size_t j = 0; j < n; ++j)
      x[j] = {from[2 * j].lanes[lane], from[2 * j + 1].lanes[lane]};
    std::vector<std::complex<Number>> alone(n);
    Eigen::internal::kiss_cpx_fft<Number> plan;
    plan.make_twiddles(static_cast<int>(n), inverse);
    plan.factorize(static_cast<int>(n));
    plan.work(0, alone.data(), x.data(), 1, 1);
    for (std::size_t j = 0; j < n; ++j) {
      ASSERT_EQ(to[2 * j].lanes[lane], alone[j].real()) << n << ", " << lane << ", " << j;
      ASSERT_EQ(to[2 * j + 1].lanes[lane], alone[j].imag()) << n << ", " << lane << ", " << j;
    }
  }
}

void expect_single_transforms(const ManyTransforms& table) {
  for (const std::size_t n : {2U, 3U, 4U, 5U, 7U, 8U, 11U, 13U, 60U, 1000U, 1001U, 1024U}) {
    for (const bool inverse : {false, true}) {
      expect_single_transforms(table.of_doubles, n, inverse);
      expect_single_transforms(table.of_floats, n, inverse);
    }
  }
}

TEST(ManyTransforms, AreSingleOnesOnAnyProcessor) {
  expect_single_transforms(baseline_transforms());
}

TEST(ManyTransforms, AreSingleOnesWithAvx2) {
  if (avx2_transforms() == nullptr) GTEST_SKIP() << "this processor has no AVX2";
  expect_single_transforms(*avx2_transforms());
}

// More lengths than are kept at once, and back to the first.
TEST(ManyTransforms, KeepsNoWrongPlan) {
  for (int round = 0; round < 2; ++round) {
    for (std::size_t n = 2; n < 40; ++n)
      expect_single_transforms(many_transforms().of_doubles, n, round == 1);
  }
}

}  // namespace
}  // namespace imunoise
