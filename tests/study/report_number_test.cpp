#include <gtest/gtest.h>

#include <cmath>

#include "study/report/view/budget_view.h"
#include "study/words/number.h"
#include "study/words/text.h"

namespace imunoise::report {
namespace {

constexpr Digits kPlain = Digits::kPlain;
constexpr Digits kTypeset = Digits::kTypeset;

TEST(Number, SignificantDigits) {
  EXPECT_EQ(number(0.0, 3, kPlain), "0");
  EXPECT_EQ(number(0.11752, 3, kPlain), "0.118");
  EXPECT_EQ(number(12345.6, 3, kPlain), "12346");
  EXPECT_EQ(number(9.996, 3, kPlain), "10.0");
  EXPECT_EQ(number(99999.0, 2, kPlain), "1.0e5");
  EXPECT_EQ(number(-3.14159e-9, 3, kPlain), "-3.14e-9");
  EXPECT_EQ(number(-3.14159e-9, 3, kTypeset), "−3.14×10⁻⁹");
  EXPECT_EQ(number(2.5e12, 2, kTypeset), "2.5×10¹²");
  EXPECT_EQ(number(std::nan(""), 3, kPlain), "n/a");
}

TEST(Number, IsBriefInASentence) {
  EXPECT_EQ(brief(1536.0), "1536");
  EXPECT_EQ(brief(20.0), "20");
  EXPECT_EQ(brief(100.0), "100");
  EXPECT_EQ(brief(0.25), "0.25");
  EXPECT_EQ(brief(-1.5), "−1.5");
  EXPECT_EQ(brief(0.0), "0");
  EXPECT_EQ(brief(2e-9), "2×10⁻⁹");
  EXPECT_EQ(brief(1234567.0, 4), "1.235×10⁶");
  EXPECT_EQ(brief(-8e-12, 3, kPlain), "-8e-12");
}

TEST(Number, IntervalDecidesThePrecision) {
  EXPECT_EQ(with_interval(0.11752, 0.11708, 0.11797, kPlain), "0.1175 (0.1171 … 0.1180)");
  EXPECT_EQ(with_interval(0.999943, 0.999921, 0.999958, kPlain), "0.999943 (0.999921 … 0.999958)");
  EXPECT_EQ(with_interval(3.214e-9, 3.15e-9, 3.27e-9, kPlain), "3.21e-9 (3.15e-9 … 3.27e-9)");
  EXPECT_EQ(with_interval(3.214e-9, 3.15e-9, 3.27e-9, kTypeset), "3.21 (3.15 … 3.27) ×10⁻⁹");
  EXPECT_EQ(with_interval(20.59, 19.97, 21.2, kPlain), "20.6 (20.0 … 21.2)");
  EXPECT_EQ(with_interval(0.12, 0.01, 1.5, kPlain), "0.12 (0.01 … 1.50)");
  EXPECT_EQ(with_interval(12345.0, 12045.0, 12645.0, kPlain), "12345 (12045 … 12645)");
  EXPECT_EQ(interval(-0.5, -0.52, -0.48, kTypeset), "−0.520 … −0.480");
}

TEST(Number, WithoutAnIntervalTheValueAlone) {
  EXPECT_EQ(with_interval(0.5, 0.0, 0.0, kPlain), "0.5000");
  EXPECT_EQ(with_interval(0.5, 0.5, 0.5, kPlain), "0.5000");
  EXPECT_EQ(with_interval(0.5, std::nan(""), 1.0, kPlain), "0.5000");
  EXPECT_EQ(interval(0.5, 0.0, 0.0, kPlain), "");
  EXPECT_EQ(with_interval(0.0, 0.0, 3.2e-16, kPlain), "0 (0 … 3.2e-16)");
  EXPECT_EQ(with_interval(1e-12, 0.0, 1e-3, kPlain), "1.0e-12 (0 … 0.0010)");
}

TEST(Number, Times) {
  EXPECT_EQ(duration(2e-5), "20 µs");
  EXPECT_EQ(duration(0.02), "20 ms");
  EXPECT_EQ(duration(0.99999), "1 s");
  EXPECT_EQ(duration(2.56), "2.6 s");
  EXPECT_EQ(duration(2621.44), "44 min");
  EXPECT_EQ(duration(5400.0 * 2), "3 h");
  EXPECT_EQ(duration(86400.0 * 3), "3 d");
}

// A part shorter than a second does not go "from 0 to 0 s".
TEST(Number, StretchesHaveTheDecimalsThatTellTheirEndsApart) {
  EXPECT_EQ(stretch(120.0, 240.0), "120 to 240");
  EXPECT_EQ(stretch(0.0, 0.25), "0.00 to 0.25");
  EXPECT_EQ(stretch(10.24, 12.8), "10.2 to 12.8");
  EXPECT_EQ(stretch(2.0, 2.0), "2.000 to 2.000");
}

TEST(Number, SharesCountsAndResiduals) {
  EXPECT_EQ(percent(0.372), "37 %");
  EXPECT_EQ(percent(0.001), "< 1 %");
  EXPECT_EQ(percent(0.0), "0 %");
  EXPECT_EQ(count(1000000, kPlain), "1 000 000");
  EXPECT_EQ(count(999, kPlain), "999");
  EXPECT_EQ(signed_sigma(-0.04, kTypeset), "0.0");
  EXPECT_EQ(signed_sigma(3.14, kTypeset), "+3.1");
  EXPECT_EQ(signed_sigma(-123.4, kPlain), "-123");
}

TEST(AllanUnit, IsTheDataSheets) {
  // A wavelet variance of half a (°/h)² is an Allan deviation of 1 °/h.
  const double degree_per_hour = 4.84813681e-6;  // rad/s
  const AllanUnit gyro = allan_unit("rad/s");
  EXPECT_EQ(gyro.unit, "°/h");
  EXPECT_NEAR(gyro.deviation(0.5 * degree_per_hour * degree_per_hour), 1.0, 1e-8);
  EXPECT_NEAR(gyro.variance(gyro.deviation(3e-9)), 3e-9, 1e-20);
  const AllanUnit accelerometer = allan_unit("m/s^2");
  EXPECT_EQ(accelerometer.unit, "µg");
  EXPECT_NEAR(accelerometer.deviation(0.5 * 9.80665e-6 * 9.80665e-6), 1.0, 1e-12);
  EXPECT_EQ(allan_unit("furlong").unit, "furlong");
  EXPECT_EQ(allan_unit("").unit, "unit");
  EXPECT_EQ(squared("rad/s"), "(rad/s)²");
  EXPECT_EQ(squared("T"), "T²");
  EXPECT_EQ(squared("1"), "unit²");
}

TEST(Text, CleansEscapesMeasuresAndTranslates) {
  EXPECT_EQ(clean_text("a\nb\x1b[31m\xff\u202E"), "a b\uFFFD[31m\uFFFD\uFFFD");
  EXPECT_EQ(clean_text("\xc0\xaf\xed\xa0\x80"), "\uFFFD\uFFFD\uFFFD\uFFFD\uFFFD");
  EXPECT_EQ(clean_text("\xe2\x82"), "\uFFFD\uFFFD");
  EXPECT_EQ(escape_markup("<a href=\"x\">'&"), "&lt;a href=&quot;x&quot;&gt;&#39;&amp;");
  EXPECT_EQ(display_width("°/√h"), 4U);
  EXPECT_EQ(display_width("陀螺"), 4U);
  EXPECT_EQ(shorten("陀螺x", 4), "陀…");
  EXPECT_EQ(shorten("abcd", 4), "abcd");
  EXPECT_EQ(to_ascii("3 °/√Hz ±2σ²"), "3 deg/sqrt(Hz) +-2s^2");
}

TEST(Number, DaysAndMinutesAreUtc) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  EXPECT_EQ(day(1'700'000'000 * kSecond), "2023-11-14");
  EXPECT_EQ(minute(1'700'000'000 * kSecond), "2023-11-14 22:13");
  EXPECT_EQ(minute(1'709'251'199 * kSecond), "2024-02-29 23:59");
  EXPECT_EQ(minute(-1), "1969-12-31 23:59");
  EXPECT_EQ(minute(0), "unknown");
}

}  // namespace
}  // namespace imunoise::report
