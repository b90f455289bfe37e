// Effects of known strength hidden in real recordings: gyro X of six static replicates of an
// ADIS16405. Nobody knows all that these hold, so the question is what the diagnosis adds to its
// answer when the effect is there.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "recording/import/import.h"
#include "study/analysis/diagnose_series.h"
#include "tests/hidden_effects/generator/borrowed_scene.h"
#include "tests/hidden_effects/generator/effect.h"
#include "tests/hidden_effects/scoring/equivalence.h"
#include "tests/hidden_effects/scoring/replicates.h"
#include "tests/hidden_effects/scoring/statistics.h"
#include "tests/hidden_effects/trial_plan.h"
#include "tests/support/golden.h"

namespace imunoise::hidden {
namespace {

constexpr std::size_t kSamples = 1U << 16U;
constexpr double kCount = 0.05 * 0.017453292519943295;  // rad/s, what the device rounds to

std::vector<Series> measured() {
  std::vector<std::filesystem::path> paths;
  for (int i = 1; i <= 6; ++i) {
    paths.push_back(testing::shared("data/adis16405/replicate" + std::to_string(i) + "_gyro.h5"));
  }
  recording::ImportOptions options;
  options.channels = {"gyro_x"};
  const auto replicates = recording::import_files(paths, options).value();
  std::vector<Series> out;
  for (const recording::Replicate& replicate : replicates) {
    const Signal signal = replicate.channels.front().signal();
    Series& x = out.emplace_back(kSamples);
    for (std::size_t t = 0; t < kSamples; ++t) x[t] = signal.value(t);
  }
  return out;
}

v1::DiagnosisReport ask(const Scene& scene) {
  study::DiagnoseOptions options;
  options.model = "WN + 2*AR1 + RW";
  options.automatic = true;
  return study::diagnose_series(to_replicates(scene.recordings, scene.rate_hz), 0, options).value();
}

// Whether the report adds one of the names, or puts it among its first three.
bool tells(const v1::DiagnosisReport& report, const std::vector<std::string>& names) {
  const auto right = [&](const auto& one) {
    return std::find(names.begin(), names.end(), one.effect()) != names.end();
  };
  if (std::any_of(report.ladder().begin(), report.ladder().end(), right)) return true;
  const auto& candidates = report.candidates();
  const auto end = candidates.begin() + std::min(3, candidates.size());
  return report.verdict() != v1::none && std::any_of(candidates.begin(), end, right);
}

std::string summary(const v1::DiagnosisReport& report) {
  std::string out = v1::Verdict_Name(report.verdict());
  for (int i = 0; i < std::min(3, report.candidates_size()); ++i) {
    out += " " + report.candidates(i).effect();
  }
  for (const v1::Rung& rung : report.ladder()) {
    if (!rung.added().empty()) out += " +" + rung.added();
  }
  return out;
}

TEST(HiddenEffectsTrial, InRealRecordings) {
  IMUNOISE_NEEDS("data/adis16405/replicate1_gyro.h5");
  const TrialPlan plan = trial_plan();
  const std::vector<Series> real = measured();
  const RandomStream random(plan.seed(0), {16405});
  const v1::DiagnosisReport before = ask(borrow_scene(real, 100.0, random));
  std::printf("as recorded: %s\n", summary(before).c_str());
  Share told;
  constexpr std::array kEffects = {
      "line", "step", "warm_up", "temperature/static", "temperature/lagged", "supply_voltage"};
  for (const char* const name : kEffects) {
    const HiddenEffect& effect = *find_effect(name);
    const std::vector<std::string> right = right_names(effect, false);
    for (std::size_t i = 0; i < plan.repeats; ++i) {
      Scene scene = borrow_scene(real, 100.0, random);
      scene.random = RandomStream(plan.seed(i), {1});
      effect.hide(scene, 16.0);
      for (Recording& recording : scene.recordings) {
        for (double& x : recording[kSubject]) x = kCount * std::round(x / kCount);
      }
      const v1::DiagnosisReport after = ask(scene);
      told.add(tells(after, right));
      std::printf("  %-20s seed %llu: %s\n", name, static_cast<unsigned long long>(plan.seed(i)),
                  summary(after).c_str());
    }
    if (tells(before, right))
      std::printf("  (%s is told of the recordings as they are, too)\n", name);
  }
  std::printf("told of those hidden at δ = 16: %s\n", to_string(told).c_str());
  EXPECT_GE(told.upper(), 0.9);
}

}  // namespace
}  // namespace imunoise::hidden
