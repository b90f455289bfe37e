// The grammar of models with effects.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/effects/known_effects.h"
#include "core/effects/parse_full_model.h"

namespace imunoise {
namespace {

constexpr Hertz kEffectRate{100.0};

TEST(EffectTerm, EveryKindIsReadAsItIsPrinted) {
  for (const char* text :
       {"WN + RW", "WN + RW + ramp", "WN + ramp(own)", "WN + warm_up(tau=600)",
        "WN + warm_up(tau=0.25, own)", "WN + RW + line(f=23.4)", "WN + line(f=0.5, harmonics=3)",
        "WN + step(replicate=2, t=1234.5)", "WN + RW + witness(temperature)",
        "WN + witness(acc x, lag=300)", "WN + witness(gyro_y, from=0.1, to=10)",
        "WN + witness(temperature, quadratic)", "WN + witness(temperature, lag=2, own)",
        "WN + modulated(temperature)", "WN + RW + telegraph", "WN + outliers(above=6)",
        "AR1 + WN + own_powers"}) {
    const Result<FullModel> read = parse_full_model(text, kEffectRate);
    ASSERT_TRUE(read) << text << ": " << read.error().message;
    EXPECT_EQ(print(*read), text);
    EXPECT_EQ(*parse_full_model(print(*read), kEffectRate), *read) << text;
  }
}

TEST(EffectTerm, EffectsMayStandAnywhereAndADriftIsARampOfEachReplicate) {
  const Result<FullModel> read =
      parse_full_model("line(f=2e+0)+WN( sigma2=1e+0 ) + DR", kEffectRate);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(print(*read), "WN(sigma2=1) + line(f=2) + ramp(own)");
}

TEST(EffectTerm, TheTimeOfAStepIsRoundedWithinItsSample) {
  const Hertz rate{819.2};
  for (int sample = 1; sample < 100'000; sample += 7) {
    const EffectTerm found(effect_named("step"), "",
                           {{"replicate", 1.0}, {"t", sample / rate.value}});
    const EffectTerm step = rounded(found, 0.0, rate);
    EXPECT_EQ(std::lround(step["t"] * rate.value), sample);
    EXPECT_LE(fmt::format("{}", step["t"]).size(), std::string_view("122.123").size());
  }
}

TEST(EffectTerm, WhatIsWrongIsSaid) {
  const auto message = [](const char* text) {
    const Result<FullModel> read = parse_full_model(text, kEffectRate);
    return read ? "accepted" : read.error().message;
  };
  EXPECT_EQ(message("WN + line"), "line: needs f=…, a number > 0");
  EXPECT_EQ(message("WN + line(f=abc)"), "line(f=abc): 'abc' is not a number from 0 to 1e15");
  EXPECT_EQ(message("WN + line(f=-1)"), "line(f=-1): '-1' is not a number from 0 to 1e15");
  EXPECT_EQ(message("WN + line(f=1, harmonics=2.5)"),
            "line(f=1, harmonics=2.5): harmonics is a whole number from 1 to 50");
  EXPECT_EQ(message("WN + ramp(tau=3)"),
            "ramp(tau=3): 'tau=3' is not known here; it takes own, slope=…");
  EXPECT_EQ(message("WN + witness()"), "witness(): needs the name of a channel");
  EXPECT_EQ(message("WN + step(replicate=1.5, t=3)"),
            "step(replicate=1.5, t=3): replicate is a whole number, counted from 1");
  EXPECT_EQ(message("ramp"), message(""));
  EXPECT_EQ(message("WN + line(f=1, f=2)"), "line(f=1, f=2): 'f' is given twice");
  EXPECT_EQ(message("WN + line(f=1e300)"), "line(f=1e300): '1e300' is not a number from 0 to 1e15");
  EXPECT_EQ(message("WN + witness(t, from=2, to=1)"),
            "witness(t, from=2, to=1): from must lie below to");
  EXPECT_EQ(message("WN + line(f=1) + LINE(f=1)"), "LINE(f=1): is in the model already");
  EXPECT_NE(message("WN + outliers(above=1)").find("at least 3"), std::string::npos);
  for (const char* unknown : {"WN + QQ", "WN + lien(f=3)"}) {
    EXPECT_NE(message(unknown).find("unknown process"), std::string::npos);
    EXPECT_NE(message(unknown).find("ramp, warm_up, line"), std::string::npos) << message(unknown);
  }
}

}  // namespace
}  // namespace imunoise
