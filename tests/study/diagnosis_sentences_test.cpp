// What a diagnosis says in words: where the model fails, and what the whole ladder found.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <regex>
#include <set>

#include "core/effects/parse_full_model.h"
#include "study/analysis/diagnose_series.h"
#include "study/analysis/diagnosis_report.h"
#include "study/analysis/sentences/ladder_findings.h"
#include "study/analysis/sentences/misfit_sentences.h"

namespace imunoise::study {
namespace {

constexpr Hertz kFifty{50.0};

std::vector<recording::Replicate> three_of(const std::string& noise, double amplitude, double f) {
  std::vector<recording::Replicate> out;
  for (std::uint32_t k = 0; k < 3; ++k) {
    std::vector<double> samples = simulate(*parse_model(noise, kFifty), 4096, 51, k);
    for (std::size_t t = 0; t < samples.size(); ++t) {
      const double seconds = static_cast<double>(t) / kFifty.value;
      samples[t] += amplitude * std::sin(2.0 * std::numbers::pi * f * seconds + k);
    }
    recording::Channel channel{"gyro_x",
                               std::make_shared<recording::Samples>(samples),
                               0,
                               4096,
                               1.0,
                               0.0,
                               *parse_unit("rad/s"),
                               kFifty};
    out.push_back({fmt::format("run{}", k + 1), "", kFifty, {channel}});
  }
  return out;
}

// A report in which everything fails everywhere: alternating scales, stretches and replicates.
v1::DiagnosisReport failing_everywhere() {
  v1::DiagnosisReport out;
  out.set_channel("gyro_x");
  for (int i = 0; i < 20; ++i) {
    const double sign = i % 2 == 0 ? 1.0 : -1.0;
    out.mutable_before()->add_scales_s(0.02 * std::pow(2.0, i));
    out.mutable_before()->add_model(1.0);
    out.mutable_before()->add_measured(1.0 + sign * 0.002);
    out.mutable_before()->add_residual(sign * (4.0 + i));
    out.mutable_before()->add_tested(true);
  }
  for (int k = 0; k < 6; ++k) {
    v1::ReplicateResidual& one = *out.mutable_compared_before()->add_replicates();
    one.set_name(fmt::format("run{}", k + 1));
    for (int i = 0; i < 20; ++i) {
      one.add_scales_s(out.before().scales_s(i));
      one.add_measured(1.5);
      one.add_residual(30.0 + k);
    }
    for (int t = 0; t < 16; ++t) {
      v1::TimeStretch& stretch = *out.mutable_compared_before()->add_times();
      stretch.set_replicate(one.name());
      stretch.set_from(10.0 * t);
      stretch.set_to(10.0 * t + 10.0);
      stretch.set_ratio(t % 2 == 0 ? 1.004 : 0.996);
      stretch.set_sigma((t % 2 == 0 ? 1.0 : -1.0) * (5.0 + k));
    }
  }
  return out;
}

TEST(Misfits, AreAtMostTwelveWorstFirst) {
  v1::DiagnosisReport report = failing_everywhere();
  add_misfits({}, report);
  ASSERT_GT(report.misfits_size(), 0);
  EXPECT_LE(report.misfits_size(), 12);
  for (int i = 1; i < report.misfits_size(); ++i)
    EXPECT_GE(std::abs(report.misfits(i - 1).sigma()), std::abs(report.misfits(i).sigma())) << i;
  EXPECT_EQ(report.misfits(0).kind(), "replicate") << report.misfits(0).sentence();
}

// Stretches of one kind are one sentence; so are the replicates.
TEST(Misfits, AreMergedOverTimeAndReplicates) {
  v1::DiagnosisReport report = failing_everywhere();
  report.mutable_before()->clear_scales_s();
  report.mutable_before()->clear_residual();
  add_misfits({}, report);
  std::multiset<std::string> kinds;
  for (const v1::Misfit& one : report.misfits()) {
    kinds.insert(one.kind());
    EXPECT_EQ(one.sentence().find(" 0 %"), std::string::npos) << one.sentence();
  }
  EXPECT_EQ(kinds.count("time"), 2U);  // more, and less
  const v1::Misfit& time = *std::find_if(report.misfits().begin(), report.misfits().end(),
                                         [](const auto& one) { return one.kind() == "time"; });
  EXPECT_NE(time.sentence().find("run6"), std::string::npos) << time.sentence();
  EXPECT_NE(time.sentence().find("0.40 %"), std::string::npos) << time.sentence();
  EXPECT_NE(time.sentence().find("48 stretches of 6 replicates"), std::string::npos)
      << time.sentence();
}

TEST(Ladder, AModelComesBackWhateverTheOrderOfItsTerms) {
  const auto model = [](const char* text) { return *parse_full_model(text, kFifty); };
  ModelsSeen prepared;
  EXPECT_TRUE(prepared.is_new(model("WN + AR1 + RW + line(f=7) + ramp")));
  EXPECT_TRUE(prepared.is_new(model("WN + 2*AR1 + RW + line(f=7) + ramp")));
  EXPECT_TRUE(prepared.is_new(model("WN + AR1 + RW + line(f=8) + ramp")));
  EXPECT_FALSE(prepared.is_new(model("RW + ramp + AR1 + WN + line(f=7)")));
}

TEST(Ladder, TheHeadlineNamesAllThatItFoundWithAmplitudes) {
  DiagnoseOptions options;
  options.model = "WN + RW";
  options.automatic = true;
  constexpr double kAmplitude = 0.4;
  const auto report = diagnose_series(
      three_of("WN(sigma2=1) + RW(gamma2=1e-5) + QN(q2=0.3)", kAmplitude, 7.0), 0, options);
  ASSERT_TRUE(report) << report.error().message;
  ASSERT_EQ(report->findings_size(), 2) << report->summary();
  std::map<std::string, v1::LadderFinding> found;
  for (const v1::LadderFinding& one : report->findings()) {
    found[one.effect()] = one;
    EXPECT_NE(report->summary().find(one.sentence()), std::string::npos) << report->summary();
  }
  const v1::EffectParameter& line = found["line"].size();
  EXPECT_EQ(line.unit(), "rad/s");
  EXPECT_LT(line.lower(), kAmplitude);
  EXPECT_GT(line.upper(), kAmplitude);
  // Q in rad of a power of 0.3 (rad/s)² at 50 Hz.
  const v1::EffectParameter& quantum = found["quantisation"].size();
  EXPECT_EQ(quantum.unit(), "rad");
  EXPECT_LT(quantum.lower(), std::sqrt(0.3) / 50.0);
  EXPECT_GT(quantum.upper(), std::sqrt(0.3) / 50.0);
}

// The Allan deviation of a scale stands at half of the averaging time of its wavelet.
TEST(Views, AnAllanDeviationStandsAtItsOwnAveragingTime) {
  DiagnoseOptions options;
  options.model = "WN";
  const auto report =
      diagnose_series(three_of("WN(sigma2=1) + RW(gamma2=1e-3)", 0.0, 7.0), 0, options);
  ASSERT_TRUE(report) << report.error().message;
  const v1::NoiseBudget& budget = report->before();
  const v1::ErrorView& view = report->ladder(0).views(0);
  ASSERT_EQ(view.view(), "averaging_times");
  int found = 0;
  for (int i = 0; i < budget.scales_size(); ++i) {
    if (std::abs(2.0 * view.from() - budget.scales_s(i)) > 1e-9) continue;
    ++found;
    const double deviation = std::sqrt(budget.measured(i) / budget.model(i)) - 1.0;
    EXPECT_NE(view.sentence().find(fmt::format("{:.0f} %", 100.0 * deviation)), std::string::npos)
        << view.sentence() << " " << deviation;
    EXPECT_NE(view.sentence().find(fmt::format("{:.3g} s", 0.5 * budget.scales_s(i))),
              std::string::npos)
        << view.sentence();
  }
  EXPECT_EQ(found, 1) << view.sentence();
}

// Of six views of a true model one is beyond 1 % once in seventeen: that is chance. A wave grows.
TEST(Views, AreBeyondChanceWhereNoneOfThemWouldBe) {
  int near = 0;
  for (const double amplitude : {0.05, 0.056, 0.058, 0.06, 0.066}) {
    DiagnoseOptions options;
    options.model = "WN";
    const auto report = diagnose_series(three_of("WN(sigma2=1)", amplitude, 7.0), 0, options);
    ASSERT_TRUE(report) << report.error().message;
    const auto& views = report->ladder(0).views();
    for (const v1::ErrorView& one : views) {
      const bool chance = 1.0 - std::pow(1.0 - one.p(), views.size()) >= 0.05;
      near += one.p() < 0.05 && chance ? 1 : 0;
      EXPECT_EQ(one.sentence().find("no more than chance") != std::string::npos, chance)
          << one.sentence() << " " << one.p();
    }
  }
  EXPECT_GT(near, 0);
}

// What a rung added, in the grammar, and the noise of that as it was fitted, if there was any.
struct AddedByRung {
  std::string term;
  std::string noise{};
};

// The findings of a ladder that added these, each of a known cause, and ended with this model.
v1::DiagnosisReport findings_of(const char* model, const std::vector<AddedByRung>& added,
                                Quantity quantity = Quantity::kAngularRate) {
  FullModel start = *parse_full_model(model, kFifty);
  for (Term& term : start.noise.terms) term.given.assign(term.given.size(), false);
  const std::vector<double> samples = simulate(start.noise, 4096, 52, 0);
  const Signal signal(std::span<const double>(samples), kFifty, quantity);
  const FittedModel last =
      fit_full_model(std::make_shared<const Subject>(make_subject({signal, signal}, {})), start);
  v1::DiagnosisReport out;
  out.add_ladder();
  std::vector<std::optional<Process>> noise{std::nullopt};
  for (const AddedByRung& one : added) {
    v1::Rung& rung = *out.add_ladder();
    rung.set_added(one.term);
    rung.set_effect("resonance");
    noise.emplace_back();
    if (!one.noise.empty()) noise.back() = parse_model(one.noise, kFifty)->terms.front().process;
  }
  add_findings(last, noise, out);
  return out;
}

TEST(Ladder, ManyResonancesMayBeOneFilter) {
  v1::DiagnosisReport report;
  for (int i = 0; i < 2; ++i) report.add_findings()->set_effect("resonance");
  v1::DiagnosisReport two = report;
  add_remaining(DiagnosisVerdict::kNone, two);
  EXPECT_EQ(two.notes_size(), 0);
  report.add_findings()->set_effect("resonance");
  add_remaining(DiagnosisVerdict::kNone, report);
  ASSERT_EQ(report.notes_size(), 1);
  EXPECT_NE(report.notes(0).find("3 resonances may together be one filter"), std::string::npos);
  const std::string once = "3 resonances, which may together be one filter of unknown form";
  EXPECT_NE(report.summary().find(once), std::string::npos) << report.summary();
  EXPECT_EQ(report.summary().find(once), report.summary().rfind(once));
}

// What the best effect does not explain, several do.
TEST(Ladder, SeveralEffectsHaveAVerdict) {
  v1::DiagnosisReport report;
  report.set_verdict(v1::unknown);
  report.add_findings()->set_sentence("a");
  v1::DiagnosisReport fails = report;
  add_remaining(DiagnosisVerdict::kNone, report);
  EXPECT_EQ(report.verdict(), v1::several);
  add_remaining(DiagnosisVerdict::kUnknown, fails);
  EXPECT_EQ(fails.verdict(), v1::unknown);
}

// Two resonances are two, each with its own frequency, ω/2π of 50 Hz, and its deviation, whether or
// not the channel has a unit.
TEST(Ladder, EachResonanceHasItsOwnFrequency) {
  for (const Quantity quantity : {Quantity::kAngularRate, Quantity::kUnknown}) {
    const v1::DiagnosisReport report = findings_of(
        "WN(sigma2=1) + RES(sigma2=1, r=0.97, omega=0.6) + RES(sigma2=1, r=0.97, omega=2.2)",
        {{"RES", "RES(sigma2=1, r=0.98, omega=2.3)"}, {"RES", "RES(sigma2=1, r=0.96, omega=0.5)"}},
        quantity);
    ASSERT_EQ(report.findings_size(), 2);
    EXPECT_EQ(report.findings(0).size().name(), "standard deviation");
    const std::string first = report.findings(0).sentence();
    const std::string second = report.findings(1).sentence();
    EXPECT_NE(first.find("RES at 17.4"), std::string::npos) << first;
    EXPECT_NE(second.find("RES at 4.77"), std::string::npos) << second;
  }
}

// Of two Markov processes, the size is that of the one that a rung added.
TEST(Ladder, EachMarkovProcessHasItsOwnSize) {
  const v1::DiagnosisReport report =
      findings_of("AR1(sigma2=1, phi=0.5) + AR1(sigma2=0.01, phi=0.99)",
                  {{"AR1", "AR1(sigma2=0.02, phi=0.98)"}});
  ASSERT_EQ(report.findings_size(), 1);
  // √(0.01/(1 - 0.99²)) = 0.71, not √(1/(1 - 0.5²)) = 1.15; a correlation time is 100 of 8,192
  // samples, so that one standard error is 0.08.
  EXPECT_NEAR(report.findings(0).size().value(), 0.71, 0.24);
}

// Noise that comes with a coupling is one rung, and no less found than either alone.
TEST(Ladder, NamesNoiseThatCameWithACoupling) {
  const v1::DiagnosisReport report = findings_of("WN(sigma2=1) + RW(gamma2=1e-5) + line(f=0.02)",
                                                 {{"RW + line(f=0.02)", "RW(gamma2=1e-5)"}});
  ASSERT_EQ(report.findings_size(), 1);
  EXPECT_EQ(report.findings(0).term(), "RW + line(f=0.02)");
  EXPECT_EQ(report.findings(0).size().unit(), "rad/s");
}

// Of what a rung added, the part that was dropped later is not named.
TEST(Ladder, NamesOnlyWhatTheLastModelHas) {
  const v1::DiagnosisReport report =
      findings_of("WN(sigma2=1) + line(f=0.02)",
                  {{"RW + line(f=0.02)", "RW(gamma2=1e-5)"}, {"RW", "RW(gamma2=1e-5)"}});
  ASSERT_EQ(report.findings_size(), 1);
  EXPECT_EQ(report.findings(0).term(), "line(f=0.02)");
}

// What a coupling adds to the samples is told in their unit.
TEST(Ladder, ACouplingIsToldByWhatItAddsToTheSamples) {
  auto recordings = three_of("WN(sigma2=1)", 0.0, 1.0);
  constexpr double kCoefficient = 0.05;
  double squares = 0.0;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const auto walk = simulate(*parse_model("AR1(sigma2=0.1, phi=0.995)", kFifty), 4096, 52, k);
    auto sum = std::get<std::vector<double>>(*recordings[k].channels[0].samples);
    const double mean = std::accumulate(walk.begin(), walk.end(), 0.0) / 4096.0;
    for (std::size_t t = 0; t < sum.size(); ++t) {
      sum[t] += kCoefficient * walk[t];
      squares += (walk[t] - mean) * (walk[t] - mean) / (3.0 * 4096.0);
    }
    recordings[k].channels[0].samples = std::make_shared<recording::Samples>(sum);
    recordings[k].channels.push_back({"temperature", std::make_shared<recording::Samples>(walk), 0,
                                      4096, 1.0, 0.0, *parse_unit("K"), kFifty});
  }
  DiagnoseOptions options;
  options.model = "WN";
  options.automatic = true;
  const auto report = diagnose_series(recordings, 0, options);
  ASSERT_TRUE(report) << report.error().message;
  ASSERT_GE(report->findings_size(), 1) << report->summary();
  const v1::EffectParameter& rms = report->findings(0).size();
  EXPECT_EQ(rms.unit(), "rad/s");
  EXPECT_LT(rms.lower(), kCoefficient * std::sqrt(squares));
  EXPECT_GT(rms.upper(), kCoefficient * std::sqrt(squares));
}

// Causes that the data cannot separate are a list: commas, and one "or".
TEST(Diagnose, ListsWhatItCouldBe) {
  DiagnoseOptions options;
  options.model = "WN";
  const auto recordings = three_of("WN(sigma2=1e-6) + AR1(sigma2=1e-7, phi=0.99)", 0.0, 1.0);
  const auto report = diagnose_series(recordings, 0, options);
  ASSERT_TRUE(report) << report.error().message;
  ASSERT_EQ(report->verdict(), v1::one_of);
  ASSERT_GT(report->candidates(0).confused_with_size(), 1);
  const std::regex list("An effect is missing: [a-zA-Z -]+(, [a-zA-Z -]+)+ or [a-zA-Z -]+\\. .*");
  EXPECT_TRUE(std::regex_match(report->summary(), list)) << report->summary();
}

}  // namespace
}  // namespace imunoise::study
