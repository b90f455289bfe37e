// The model that `select` chooses, and what it says beside it.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/spectrum/cross_power.h"
#include "study/analysis/fit_series.h"
#include "study/analysis/select_model.h"
#include "study/analysis/series.h"
#include "study/analysis/test_series.h"

namespace imunoise::study {
namespace {

constexpr Hertz kHundred{100.0};

std::vector<recording::Replicate> simulated(const std::string& model, std::uint32_t replicates,
                                            std::size_t samples) {
  std::vector<recording::Replicate> out;
  for (std::uint32_t k = 0; k < replicates; ++k) {
    auto x = std::make_shared<recording::Samples>(
        simulate(*parse_model(model, kHundred), samples, 61, k));
    recording::Channel channel{"gyro_x", x, 0, samples, 1.0, 0.0, *parse_unit("rad/s"), kHundred};
    out.push_back({fmt::format("run{}", k + 1), "", kHundred, {channel}});
  }
  return out;
}

v1::ChoiceReport choice_of(const std::vector<recording::Replicate>& replicates,
                           const std::vector<std::string>& models) {
  SelectOptions options;
  options.models = models;
  const auto out = select_model(series_of(replicates, 0), options);
  EXPECT_TRUE(out) << out.error().message;
  return *out;
}

bool has_note(const auto& report, const std::string& words) {
  return std::any_of(report.notes().begin(), report.notes().end(), [&](const std::string& note) {
    return note.find(words) != std::string::npos;
  });
}

TEST(Choice, IsByHeldOutLikelihoodBesideThePublishedCriterion) {
  const auto replicates = simulated("WN(sigma2=1) + RW(gamma2=2e-6)", 4, 16'384);
  const v1::ChoiceReport report = choice_of(replicates, {"AR1 + WN + RW"});
  EXPECT_EQ(report.chosen(), "WN + RW") << report.summary();
  EXPECT_EQ(model_to_use(report).model(), "WN + RW");
  EXPECT_NE(report.summary().find("By CV-WVIC"), std::string::npos) << report.summary();
  int best = 0;
  for (const v1::CandidateModel& one : report.candidates()) {
    ASSERT_TRUE(one.has_shortfall()) << one.model();
    EXPECT_GE(one.shortfall(), 0.0);
    EXPECT_LE(one.replicates_worse(), 4U);
    best += one.shortfall() == 0.0 ? 1 : 0;
    if (one.model() == "WN") {
      EXPECT_GT(one.shortfall(), 3.0);
    }
  }
  EXPECT_GE(best, 1);  // two where an AR1 with phi at 1 is the walk
}

// Blocks of time lose the slowest frequencies; bands that are dealt out do not.
TEST(Choice, ASingleReplicateShowsItsWalk) {
  const auto replicates = simulated("WN(sigma2=1) + RW(gamma2=1e-6)", 1, 32'768);
  const v1::ChoiceReport report = choice_of(replicates, {"WN + RW"});
  EXPECT_EQ(report.chosen(), "WN + RW") << report.summary();
  EXPECT_TRUE(has_note(report, "a sixth of the frequencies"));
}

TEST(Choice, FlickerAndQuantisationAreOffered) {
  for (const std::string added : {"FN", "QN"}) {
    const std::string truth =
        added == "FN" ? "WN(sigma2=1) + FN(b2=0.05)" : "WN(sigma2=1) + QN(q2=1) + RW(gamma2=1e-5)";
    const v1::ChoiceReport report = choice_of(simulated(truth, 3, 8192), {});
    EXPECT_NE(report.chosen().find(added), std::string::npos) << report.summary();
    EXPECT_GT(report.candidates_size(), 11);
  }
}

// By the likelihood, and by CV-WVIC where replicates are too short for one.
TEST(Choice, WithoutAReportIsTheSame) {
  for (const std::size_t samples : {4096U, 15U}) {
    const auto replicates = simulated("WN(sigma2=1) + RW(gamma2=1e-3)", 3, samples);
    SelectOptions options;
    options.models = {"AR1 + WN + RW"};
    if (samples < kFewestSamples) options.models = {"WN", "RW"};
    const Series series = series_of(replicates, 0);
    const auto report = select_model(series, options);
    const auto chosen = chosen_model(series, options);
    ASSERT_TRUE(report) << report.error().message;
    ASSERT_TRUE(chosen) << chosen.error().message;
    EXPECT_EQ(report->chosen().empty(), samples < kFewestSamples);
    EXPECT_EQ(*chosen, model_to_use(*report).model());
    EXPECT_NE(*chosen, "AR1 + WN + RW");
  }
}

TEST(Choice, ANegativePhiMayBeQuantisation) {
  const auto replicates = simulated("QN(q2=1) + WN(sigma2=0.1)", 3, 4096);
  EXPECT_TRUE(has_note(choice_of(replicates, {"AR1"}), "Quantisation noise does so"));
  FitOptions options;
  options.model = "AR1";
  const auto fit = fit_series(series_of(replicates, 0), options);
  ASSERT_TRUE(fit) << fit.error().message;
  EXPECT_TRUE(has_note(*fit, "Quantisation noise does so"));
  options.model = "QN + WN";
  EXPECT_FALSE(has_note(*fit_series(series_of(replicates, 0), options), "Quantisation noise"));
}

TEST(Choice, AModelWithoutNoiseIsRefused) {
  const auto replicates = simulated("WN(sigma2=1)", 3, 4096);
  const Series series = series_of(replicates, 0);
  for (const std::string model : {"DR", "WN(sigma2=0)", "WN(sigma2=0) + DR"}) {
    SelectOptions select;
    select.models = {model, "WN"};
    FitOptions fit;
    fit.model = model;
    TestOptions test;
    test.model = model;
    const auto refusal = [](const auto& out) { return out ? std::string() : out.error().message; };
    EXPECT_NE(refusal(select_model(series, select)).find("no noise"), std::string::npos) << model;
    EXPECT_NE(refusal(fit_series(series, fit)).find("no noise"), std::string::npos) << model;
    EXPECT_NE(refusal(test_series(series, test)).find("no noise"), std::string::npos) << model;
  }
}

}  // namespace
}  // namespace imunoise::study
