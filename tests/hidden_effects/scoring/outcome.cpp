#include "tests/hidden_effects/scoring/outcome.h"

#include <algorithm>
#include <cstdio>

#include "study/analysis/diagnose_series.h"
#include "tests/hidden_effects/scoring/equivalence.h"
#include "tests/hidden_effects/scoring/replicates.h"

namespace imunoise::hidden {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::vector<std::string> right_names(const CaseSpec& spec) {
  std::vector<std::string> out;
  for (const std::string& name : spec.effects) {
    const auto names = hidden::right_names(*find_effect(name), spec.withhold);
    out.insert(out.end(), names.begin(), names.end());
  }
  return out;
}

Result<v1::DiagnosisReport> ask(const std::vector<Recording>& recordings, const HiddenCase& made,
                                bool automatic) {
  study::DiagnoseOptions options;
  options.model = made.base.model;
  options.automatic = automatic;
  const auto replicates = to_replicates(recordings, made.rate_hz);
  const auto& channels = replicates.front().channels;
  const auto subject = std::find_if(channels.begin(), channels.end(),
                                    [](const auto& channel) { return channel.name == kSubject; });
  return study::diagnose_series(replicates, static_cast<std::size_t>(subject - channels.begin()),
                                options);
}

bool Outcome::detected() const {
  return report.verdict() == v1::found || abstained() || report.integrity_size() > 0;
}

bool Outcome::named(std::size_t ranks) const {
  const std::vector<std::string> right = right_names(spec);
  for (const v1::IntegrityFinding& finding : report.integrity()) {
    if (contains(right, finding.effect())) return true;
  }
  if (!detected()) return false;
  const std::size_t count = std::min(ranks, static_cast<std::size_t>(report.candidates_size()));
  for (std::size_t i = 0; i < count; ++i) {
    if (contains(right, report.candidates(static_cast<int>(i)).effect())) return true;
  }
  return false;
}

bool Outcome::confidently_wrong() const { return report.verdict() == v1::found && !named(1); }

bool Outcome::wrong_cause() const {
  const std::vector<std::string> right = right_names(spec);
  for (const v1::IntegrityFinding& finding : report.integrity()) {
    if (!contains(right, finding.effect())) return true;
  }
  return confidently_wrong() && !described();
}

bool Outcome::right_or_listed() const {
  if (named(1)) return true;
  if (report.verdict() != v1::one_of || report.candidates_size() == 0) return false;
  const auto& listed = report.candidates(0).confused_with();
  const std::vector<std::string> right = right_names(spec);
  return std::any_of(listed.begin(), listed.end(),
                     [&](const std::string& id) { return contains(right, id); });
}

bool Outcome::abstained() const {
  return report.verdict() != v1::found && report.verdict() != v1::none;
}

bool Outcome::described() const {
  static const std::vector<std::string> kNoises = {"white_noise",  "random_walk", "gauss_markov",
                                                   "second_order", "flicker",     "resonance",
                                                   "power_law"};
  return report.verdict() == v1::found && report.candidates_size() > 0 &&
         contains(kNoises, report.candidates(0).effect());
}

std::vector<Covered> Outcome::intervals() const {
  std::vector<Covered> out;
  if (report.candidates_size() == 0 || !named(1)) return out;
  const v1::EffectCandidate& first = report.candidates(0);
  for (std::size_t i = 0; i < spec.effects.size(); ++i) {
    if (find_effect(spec.effects[i])->id != first.effect()) continue;
    for (const TrueParameter& truth : injections[i].parameters) {
      for (const v1::EffectParameter& told : first.parameters()) {
        if (told.name() != truth.name || !told.has_lower() || !told.has_upper()) continue;
        out.push_back({truth.name, truth.value, told.lower(), told.upper()});
      }
    }
  }
  return out;
}

std::string Outcome::describe() const {
  if (!error.empty()) return hidden::describe(spec) + ": ERROR " + error;
  std::string out = hidden::describe(spec) + ": " + v1::Verdict_Name(report.verdict());
  const int count = std::min(3, report.candidates_size());
  for (int i = 0; i < count; ++i) {
    const v1::EffectCandidate& one = report.candidates(i);
    char gain[64];
    std::snprintf(gain, sizeof gain, " (%.1f nats, p %.2g)", one.gain_nats(), one.familywise_p());
    out += (i == 0 ? " " : ", ") + one.effect();
    if (!one.witness().empty()) out += "[" + one.witness() + "]";
    out += gain;
  }
  for (const v1::IntegrityFinding& finding : report.integrity()) {
    out += ", integrity: " + finding.effect();
  }
  for (const v1::Rung& rung : report.ladder()) {
    if (!rung.added().empty()) out += ", added " + rung.added();
  }
  return out;
}

Outcome diagnose(const CaseSpec& spec, bool automatic) {
  const HiddenCase made = make_case(spec);
  Outcome out;
  out.spec = spec;
  out.injections = made.injections;
  auto report = ask(made.recordings, made, automatic);
  if (!report) {
    out.error = report.error().message;
    return out;
  }
  out.report = std::move(*report);
  return out;
}

bool all_named(const Outcome& outcome) {
  for (const std::string& name : outcome.spec.effects) {
    const auto right = hidden::right_names(*find_effect(name), outcome.spec.withhold);
    const auto& ladder = outcome.report.ladder();
    const bool found = std::any_of(ladder.begin(), ladder.end(), [&](const v1::Rung& rung) {
      return contains(right, rung.effect());
    });
    if (!found) return false;
  }
  return true;
}

}  // namespace imunoise::hidden
