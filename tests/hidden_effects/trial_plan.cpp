#include "tests/hidden_effects/trial_plan.h"

#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <sstream>

#include "core/support/parallel.h"

namespace imunoise::hidden {

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
  std::printf("%s seeds from %llu, %zu for each effect and strength%s%s\n",
              out.test_seeds ? "test" : "development", static_cast<unsigned long long>(out.seed(0)),
              out.repeats, out.only.empty() ? "" : ", only ", out.only.c_str());
  return out;
}

std::vector<Outcome> diagnose_all(const std::vector<CaseSpec>& specs, const Questions& questions) {
  std::vector<Outcome> out(specs.size());
  for_each_index(specs.size(), [&](std::size_t i) { out[i] = diagnose(specs[i], questions); });
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
