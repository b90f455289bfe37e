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
  for (const char* text : {"WN + RW",
                           "WN + RW + ramp",
                           "WN + ramp(own)",
                           "WN + warm_up(tau=600)",
                           "WN + warm_up(tau=0.25, own)",
                           "WN + RW + line(f=23.4)",
                           "WN + line(f=0.5, harmonics=3)",
                           "WN + step(replicate=2, t=1234.5)",
                           "WN + RW + witness(temperature)",
                           "WN + witness(acc x, lag=300)",
                           "WN + witness(gyro_y, from=0.1, to=10)",
                           "WN + witness(gyro_y, from=0.1, to=10, octaves=3)",
                           "WN + witness(temperature, quadratic)",
                           "WN + witness(temperature, lag=2, own)",
                           "WN + modulated(temperature)",
                           "WN + RW + telegraph",
                           "WN + outliers(above=6)",
                           "WN + heavy_tails(dof=4)",
                           "WN + variance_wander(tau=30)",
                           "WN + bursts(length=2, every=30)",
                           "WN + oscillation(from=15, to=30)",
                           "AR1 + WN + own_powers"}) {
    const Result<FullModel> read = parse_full_model(text, kEffectRate);
    ASSERT_TRUE(read) << text << ": " << read.error().message;
    EXPECT_EQ(print(*read), text);
    EXPECT_EQ(*parse_full_model(print(*read), kEffectRate), *read) << text;
  }
}

TEST(EffectTerm, EffectsMayStandAnywhereAndADriftIsARampOfEachReplicateWhereAModelIsFitted) {
  const Result<FullModel> read =
      parse_full_model("line(f=2e+0, amplitude=3)+WN( sigma2=1e+0 ) + DR", kEffectRate);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(print(*read), "WN(sigma2=1) + DR + line(f=2, amplitude=3)");
  EXPECT_EQ(print(as_fitted(*read)), "WN(sigma2=1) + line(f=2) + ramp(own)");
  EXPECT_EQ(print(as_fitted(*parse_full_model("WN + DR + ramp(own)", kEffectRate))),
            "WN + ramp(own)");
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

TEST(EffectTerm, WhatIsWrongIsSaidWhereItStands) {
  struct Case {
    const char* text;
    std::size_t column;
    const char* says;
  };
  for (const Case& c : std::vector<Case>{
           {"WN + line", 5, "line needs f=…, a number > 0"},
           {"WN + line(f=abc)", 12, "'abc' is not a number from 0 to 1e15"},
           {"WN + line(f=-1)", 12, "'-1' is not a number from 0 to 1e15"},
           {"WN + line(f=0)", 12, "f is a number > 0"},
           {"WN + line(f=1, harmonics=2.5)", 25, "harmonics is a whole number from 1 to 50"},
           {"WN + ramp(tau=3)", 10, "'tau=3' is not known here; ramp takes own, slope=…"},
           {"WN + ramp(own=1)", 10, "'own=1' is not known here"},
           {"WN + witness()", 5, "witness needs the name of a channel"},
           {"WN + witness(heat, cold)", 19, "'cold' is not known here"},
           {"WN + step(replicate=1.5, t=3)", 20, "replicate is a whole number, counted from 1"},
           {"WN + line(f=1, f=2)", 15, "'f' is given twice"},
           {"WN + line(f=1e300)", 12, "'1e300' is not a number from 0 to 1e15"},
           {"WN + witness(t, from=2, to=1)", 5, "from must lie below to"},
           {"WN + witness(t, from=3, to=8, octaves=3)", 5, "from must lie within the lowest"},
           {"WN + witness(t, octaves=2.5)", 24, "octaves is a whole number from 1 to 24"},
           {"WN + line(f=1) + LINE(f=1, amplitude=2)", 17, "is in the model already"},
           {"WN + outliers(above=1)", 5, "at least 3"},
           {"WN + 2*line(f=1)", 5, "an effect stands once"},
           {"WN + line(f=1)[all]", 15, "sensors share processes, not effects"},
           {"ramp", 4, "at least one noise process"},
           {"", 0, "expected the name of a process"},
           {"WN + lien(f=3)", 5, "unknown process or effect 'lien'"},
           {"WN + zzzzzz", 5, "effects: ramp, warm_up, line, "},
           {"WN + line(f=1, harmonics=(2)", 28, "expected ',' or ')'"}}) {
    const Result<FullModel> read = parse_full_model(c.text, kEffectRate);
    ASSERT_FALSE(read) << c.text;
    const std::string& message = read.error().message;
    EXPECT_NE(message.find(c.says), std::string::npos) << message;
    EXPECT_EQ(message.size() - message.rfind('\n') - 1, c.column + 3) << message;
  }
}

TEST(Grammar, WhoCannotTakeAnEffectSaysWhichAndWhy) {
  const auto message = [](const char* text, const Grammar& grammar) {
    const auto read = parse_full_model(text, kEffectRate, grammar);
    return read ? "accepted" : read.error().message;
  };
  EXPECT_EQ(message("RW[all] + WN", grammar_of_arrays()), "accepted");
  EXPECT_EQ(message("WN(sigma2~exp) + QN", grammar_over_covariate()), "accepted");
  EXPECT_NE(message("RW[all] + line(f=5)", grammar_of_arrays()).find("line is an effect"),
            std::string::npos);
  EXPECT_NE(message("QN + ramp", grammar_over_covariate()).find("bins of a covariate"),
            std::string::npos);
  EXPECT_EQ(message("WN + ramp + outliers(above=6)", grammar_of_replicates("imunoise test")),
            "accepted");
  for (const Effect* effect : known_effects()) {
    if (!changes_noise(*effect)) continue;
    const std::string text =
        fmt::format("WN + {}{}", effect->name, effect->witness ? "(heat)" : "");
    const std::string why = message(text.c_str(), grammar_of_replicates("imunoise test"));
    EXPECT_NE(why.find(std::string(effect->name) + " changes the noise itself, and imunoise test"),
              std::string::npos)
        << why;
    EXPECT_EQ(message(text.c_str(), {}), "accepted");
  }
}

TEST(Grammar, AChoiceIsBetweenTheNoiseOfModelsWithTheSameEffects) {
  std::vector<FullModel> models;
  const auto add = [&](const char* text) {
    const auto done = add_candidate(text, kEffectRate, "imunoise select", models);
    return done ? "added" : done.error().message;
  };
  EXPECT_EQ(add("WN + line(f=5) + ramp"), "added");
  EXPECT_EQ(add("ramp + WN + AR1 + line(f=5)"), "added");
  EXPECT_NE(add("WN + RW").find("different effects"), std::string::npos);
  EXPECT_NE(add("line(f=5) + AR1 + ramp + WN").find("are the same"), std::string::npos);
  EXPECT_EQ(models.size(), 2U);
}

}  // namespace
}  // namespace imunoise
