#include "core/wavelet/wavelet_variance.h"

#include <gtest/gtest.h>

#include <random>

#include "core/support/parallel.h"
#include "core/wavelet/kernels.h"
#include "core/wavelet/prefix_sums.h"
#include "core/wavelet/robust_variance.h"
#include "core/wavelet/streaming_variance.h"
#include "tests/support/golden.h"

namespace imunoise {
namespace {

using testing::read_doubles;
using testing::read_json;

// The definition, coefficient by coefficient, in long double.
template <class Sample>
double variance_by_definition(const std::vector<Sample>& x, std::int64_t m) {
  const auto width = static_cast<std::size_t>(m);
  long double total = 0;
  std::size_t count = 0;
  for (std::size_t end = 2 * width; end <= x.size(); ++end, ++count) {
    long double w = 0;
    for (std::size_t i = 0; i < width; ++i) {
      w += static_cast<long double>(x[end - 1 - i]) -
           static_cast<long double>(x[end - 1 - width - i]);
    }
    w /= 2 * static_cast<long double>(m);
    total += w * w;
  }
  return static_cast<double>(total / static_cast<long double>(count));
}

template <class Sample>
std::vector<Sample> random_samples(std::size_t n, double sigma, double bias, unsigned seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal(bias, sigma);
  std::vector<Sample> out(n);
  for (Sample& x : out) x = static_cast<Sample>(normal(engine));
  return out;
}

template <class Sample>
void expect_same_as_definition(const std::vector<Sample>& x, const Scales& scales,
                               double tolerance) {
  const Signal signal{std::span<const Sample>(x), Hertz{100}};
  const WaveletVariance wv = wavelet_variance(signal, scales);
  for (std::size_t i = 0; i < scales.size(); ++i) {
    const double expected = variance_by_definition(x, scales[i]);
    EXPECT_NEAR(wv.variance(static_cast<Eigen::Index>(i)) / expected, 1.0, tolerance)
        << "m = " << scales[i];
  }
}

TEST(WaveletVariance, IsTheMeanSquareOfTheCoefficients) {
  for (const std::size_t n : {16UL, 2047UL, 2048UL, 2049UL, 5000UL}) {
    const Scales scales = Scales::for_samples(n, 4);
    expect_same_as_definition(random_samples<double>(n, 1.0, 9.8, 1), scales, 1e-12);
    expect_same_as_definition(random_samples<std::int16_t>(n, 40.0, -1234.0, 2), scales, 1e-14);
    expect_same_as_definition(random_samples<std::int32_t>(n, 1e3, 1e6, 3), scales, 1e-14);
  }
}

// Lags beyond the cached window use cursors of their own; a ramp of large counts needs 64-bit sums.
TEST(WaveletVariance, FarLagsAndWideSumsAreExact) {
  const std::size_t n = 1'300'000;
  const Scales scales({1, 3, 262'144, 262'145, 300'001, 524'288, 600'001});
  std::vector<std::int32_t> counts = random_samples<std::int32_t>(n, 5.0, 0.0, 4);
  const auto fast = [&](std::int64_t m) {  // exact in 128-bit integers
    std::vector<std::int64_t> s(n + 1);
    for (std::size_t t = 0; t < n; ++t) s[t + 1] = s[t] + counts[t];
    Total128 total = 0;
    const auto w = static_cast<std::size_t>(m);
    for (std::size_t t = 2 * w; t <= n; ++t) {
      const std::int64_t d = s[t] - 2 * s[t - w] + s[t - 2 * w];
      const auto size = static_cast<std::uint64_t>(d < 0 ? -d : d);
      total += static_cast<Total128>(size) * size;
    }
    const double count = static_cast<double>(n - 2 * w + 1);
    return static_cast<double>(total) /
           (count * 4.0 * static_cast<double>(m) * static_cast<double>(m));
  };
  for (const bool wide : {false, true}) {
    if (wide) {
      for (std::size_t t = 0; t < n; ++t) counts[t] += static_cast<std::int32_t>(1'000 * t);
    }
    const Signal signal{std::span<const std::int32_t>(counts), Hertz{100}};
    const WaveletVariance wv = wavelet_variance(signal, scales);
    for (std::size_t i = 0; i < scales.size(); ++i) {
      EXPECT_DOUBLE_EQ(wv.variance(static_cast<Eigen::Index>(i)), fast(scales[i]))
          << scales[i] << wide;
    }
    std::vector<double> numbers(counts.begin(), counts.end());
    const WaveletVariance as_doubles =
        wavelet_variance(Signal{std::span<const double>(numbers), Hertz{100}}, scales);
    // Doubles lose the digits that a steep ramp takes from the prefix sums; counts never do.
    for (Eigen::Index i = 0; i < wv.variance.size(); ++i) {
      EXPECT_NEAR(as_doubles.variance(i) / wv.variance(i), 1.0, wide ? 1e-9 : 1e-12);
    }
  }
}

TEST(WaveletVariance, IsTheSameForAnyNumberOfThreads) {
  const std::vector<double> x = random_samples<double>(3'000'000, 1.0, 0.3, 5);
  const Signal signal{std::span<const double>(x), Hertz{100}};
  const Scales scales = Scales::for_samples(x.size(), 2);
  const WaveletVariance many = wavelet_variance(signal, scales);
  const ThreadLimit one(1);
  const WaveletVariance single = wavelet_variance(signal, scales);
  EXPECT_TRUE((many.variance == single.variance).all());
}

TEST(Kernels, GiveTheSameBitsWithAndWithoutAvx2) {
  const Kernels* wide = avx2_kernels();
  if (wide == nullptr) GTEST_SKIP() << "SKIPPED: this processor has no AVX2";
  const Kernels& base = baseline_kernels();
  const std::vector<double> x = random_samples<double>(3 * kBlock, 1.0, 0.0, 6);
  const std::vector<std::int32_t> n = random_samples<std::int32_t>(3 * kBlock, 1e6, 0.0, 7);
  for (const std::size_t count : {1UL, 15UL, 16UL, 17UL, 1000UL, kBlock}) {
    const double* a = x.data() + 2 * kBlock;
    EXPECT_EQ(base.squares_double(a, a - 700, a - 1400, count),
              wide->squares_double(a, a - 700, a - 1400, count));
    const std::int32_t* b = n.data() + 2 * kBlock;
    EXPECT_EQ(base.squares_int(b, b - 700, b - 1400, count),
              wide->squares_int(b, b - 700, b - 1400, count));
    std::vector<double> one(count);
    std::vector<double> two(count);
    base.prefix_double(x.data(), 0.1, 3.0, one.data(), count);
    wide->prefix_double(x.data(), 0.1, 3.0, two.data(), count);
    EXPECT_EQ(one, two);
  }
}

TEST(StreamingVariance, EqualsTheBatchFormForAnyPieces) {
  const std::vector<std::int16_t> counts = random_samples<std::int16_t>(50'000, 30.0, 500.0, 8);
  const std::vector<double> numbers = random_samples<double>(50'000, 1.0, 9.8, 9);
  const Scales scales = Scales::for_samples(20'000, 4);
  std::mt19937 engine(10);
  StreamingVariance<std::int16_t> count_stream(scales, Hertz{100});
  StreamingVariance<double> number_stream(scales, Hertz{100});
  for (std::size_t at = 0; at < counts.size();) {
    const std::size_t piece = std::min<std::size_t>(counts.size() - at, engine() % 5000);
    count_stream.push(std::span(counts).subspan(at, piece));
    number_stream.push(std::span(numbers).subspan(at, piece));
    at += piece;
    const std::span<const std::int16_t> so_far(counts.data(), at);
    const WaveletVariance streamed = count_stream.estimate();
    const WaveletVariance batch = wavelet_variance(Signal{so_far, Hertz{100}}, streamed.scales);
    EXPECT_TRUE((streamed.variance == batch.variance).all()) << "after " << at << " samples";
  }
  const WaveletVariance batch =
      wavelet_variance(Signal{std::span<const double>(numbers), Hertz{100}}, scales);
  EXPECT_LT((number_stream.estimate().variance / batch.variance - 1.0).abs().maxCoeff(), 1e-12);
}

TEST(Golden, SmallSignalClassicalAndRobust) {
  IMUNOISE_NEEDS("golden/wv_small_and_theory.json");
  const auto golden = read_json("golden/wv_small_and_theory.json");
  const std::vector<double> x = read_doubles("golden/det1000.f64");
  const Signal signal{std::span<const double>(x), Hertz{1}};
  const Scales scales = Scales::for_samples(x.size());
  const auto compare = [&](const WaveletVariance& wv, const nlohmann::json& expected,
                           double tolerance) {
    ASSERT_EQ(expected["variance"].size(), scales.size());
    for (std::size_t i = 0; i < scales.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      EXPECT_NEAR(wv.variance(at) / expected["variance"][i].get<double>(), 1.0, tolerance);
      EXPECT_NEAR(wv.lower(at) / expected["ci_low"][i].get<double>(), 1.0, tolerance);
      EXPECT_NEAR(wv.upper(at) / expected["ci_high"][i].get<double>(), 1.0, tolerance);
    }
  };
  compare(wavelet_variance(signal, scales), golden["modwt"], 1e-12);
  // The peer's one-dimensional minimiser stops at about 1e-4 of the tuning constant.
  compare(robust_wavelet_variance(signal, scales, RobustEfficiency::k60), golden["robust_0.6"],
          5e-5);
}

TEST(RobustVariance, IsUnmovedByOutliersAndUnbiasedWithoutThem) {
  std::vector<double> x = random_samples<double>(200'000, 1.0, 0.0, 11);
  const Scales scales({1, 2, 4});
  const auto ratio = [&](RobustEfficiency e) {
    const Signal signal{std::span<const double>(x), Hertz{1}};
    return (robust_wavelet_variance(signal, scales, e).variance * 2.0 * scales.half_widths())
        .eval();
  };
  // Relative error of one scale is about √(2/edof/eff) < 1 %: five of them.
  for (const auto e : {RobustEfficiency::k60, RobustEfficiency::k80, RobustEfficiency::k90}) {
    EXPECT_LT((ratio(e) - 1.0).abs().maxCoeff(), 0.05);
  }
  for (std::size_t t = 0; t < x.size(); t += 1000) x[t] = 1e4;  // classical: ×5e4
  EXPECT_LT((ratio(RobustEfficiency::k60) - 1.0).abs().maxCoeff(), 0.05);
}

// Mean of χ(W/√ν) over the coefficients against its expectation, with outliers among them; long
// enough that the root is first sought in a part of them.
TEST(RobustVariance, SolvesItsEquation) {
  constexpr double kCut = 4.973362134160212;
  constexpr double kExpectation = 0.6367236798738104;
  std::vector<double> x = random_samples<double>(150'000, 1.0, 0.0, 12);
  for (std::size_t t = 0; t < x.size(); t += 700) x[t] = 30.0;
  const Signal signal{std::span<const double>(x), Hertz{1}};
  const Scales scales({1, 64});
  const WaveletVariance found = robust_wavelet_variance(signal, scales, RobustEfficiency::k60);
  for (std::size_t i = 0; i < scales.size(); ++i) {
    const auto m = static_cast<std::size_t>(scales[i]);
    const double nu = found.variance(static_cast<Eigen::Index>(i));
    double sum = 0.0;
    double count = 0.0;
    double w = 0.0;  // 2m W
    for (std::size_t t = 0; t < m; ++t) w += x[t + m] - x[t];
    for (std::size_t t = 2 * m;; ++t) {
      const double r2 = w * w / (4.0 * static_cast<double>(m * m) * nu);
      const double q = std::max(0.0, 1.0 - r2 / (kCut * kCut));
      sum += r2 * q * q * q * q;
      count += 1.0;
      if (t == x.size()) break;
      w += x[t] - 2.0 * x[t - m] + x[t - 2 * m];
    }
    EXPECT_NEAR(sum / count, kExpectation, 1e-9) << m;
  }
}

TEST(Scales, AreDyadicAndBetween) {
  EXPECT_EQ(Scales::for_samples(1'000'000).size(), 18U);
  EXPECT_EQ(Scales::for_samples(10'000'000).size(), 22U);
  EXPECT_EQ(Scales::for_samples(64, 4), Scales({1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16}));
  EXPECT_EQ(Scales::for_samples(64, 2), Scales({1, 2, 3, 4, 6, 8, 12, 16}));
  EXPECT_TRUE(Scales::for_samples(3).empty());
}

}  // namespace
}  // namespace imunoise
