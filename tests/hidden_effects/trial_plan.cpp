#include "tests/hidden_effects/trial_plan.h"

#include <bit>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <sstream>

#include "core/support/parallel.h"

namespace imunoise::hidden {

CaseSpec TrialPlan::null_case(std::size_t repeat) const {
  CaseSpec out;
  out.seed = seed(repeat);
  out.samples = samples;
  out.replicates = replicates;
  return out;
}

CaseSpec TrialPlan::one_effect(const std::string& name, double delta, std::size_t repeat) const {
  CaseSpec out = null_case(repeat);
  out.effects = {name};
  out.delta = delta;
  return out;
}

std::vector<double> TrialPlan::strengths_or(std::vector<double> own) const {
  return strengths.empty() ? own : strengths;
}

TrialPlan trial_plan() {
  TrialPlan out;
  const auto variable = [](const char* name) {
    const char* const value = std::getenv(name);
    return std::string(value == nullptr ? "" : value);
  };
  out.test_seeds = variable("IMUNOISE_TRIAL_SEEDS") == "test";
  if (const std::string repeats = variable("IMUNOISE_TRIAL_REPEATS"); !repeats.empty()) {
    out.repeats = std::strtoul(repeats.c_str(), nullptr, 10);
  }
  if (const std::string strengths = variable("IMUNOISE_TRIAL_STRENGTHS"); !strengths.empty()) {
    std::istringstream words(strengths);
    out.strengths.assign(std::istream_iterator<double>(words), {});
  }
  out.only = variable("IMUNOISE_TRIAL_ONLY");
  if (const std::string samples = variable("IMUNOISE_TRIAL_SAMPLES"); !samples.empty()) {
    out.samples = std::bit_floor(std::strtoul(samples.c_str(), nullptr, 10));
  }
  if (const std::string count = variable("IMUNOISE_TRIAL_REPLICATES"); !count.empty()) {
    out.replicates = std::strtoul(count.c_str(), nullptr, 10);
  }
  std::printf("%s seeds from %llu, %zu for each effect and strength, %zu × %zu samples%s%s\n",
              out.test_seeds ? "test" : "development", static_cast<unsigned long long>(out.seed(0)),
              out.repeats, out.replicates, out.samples, out.only.empty() ? "" : ", only ",
              out.only.c_str());
  return out;
}

std::vector<Outcome> diagnose_all(const std::vector<CaseSpec>& specs, bool automatic) {
  std::vector<Outcome> out(specs.size());
  for_each_index(specs.size(), [&](std::size_t i) { out[i] = diagnose(specs[i], automatic); });
  print_where("no report", out, [](const Outcome& outcome) { return !outcome.error.empty(); });
  return out;
}

void print_where(const char* heading, const std::vector<Outcome>& outcomes,
                 bool (*wrong)(const Outcome&)) {
  bool any = false;
  for (const Outcome& outcome : outcomes) {
    if (!wrong(outcome)) continue;
    if (!any) std::printf("%s:\n", heading);
    any = true;
    std::printf("  %s\n", outcome.describe().c_str());
  }
}

}  // namespace imunoise::hidden
