#include "study/analysis/sentences/ladder_findings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/diagnosis/causes.h"
#include "core/model/similar_term.h"
#include "core/support/parallel.h"
#include "study/analysis/effect_parameters.h"
#include "study/words/number.h"

namespace imunoise::study {
namespace {

using Index = Eigen::Index;

std::string printed_alone(const Term& term) {
  Model alone;
  alone.terms.push_back(term);
  return print(alone);
}

double spread(const Eigen::VectorXd& x) { return (x.array() - x.mean()).square().sum(); }

// The root mean square of what an effect adds to the samples about the mean of each replicate, in
// the channel's unit. The interval follows from the errors of its coefficients, whose regressors
// are taken as orthogonal: each replicate's own, or one alone.
ReportedNumber size_in_samples(const FittedModel& model, std::size_t effect) {
  const auto& regression = model.regression;
  const Subject& subject = regression.subject();
  const EffectCoefficients& found = model.fit.effects;
  const Index first = regression.first(effect);
  const Index count = regression.first(effect + 1) - first;
  Eigen::VectorXd others = found.value;
  others.segment(first, count).setZero();
  std::vector<double> squares(subject.replicates());
  std::vector<double> samples(subject.replicates());
  for_each_index(squares.size(), [&](std::size_t k) {
    const Eigen::VectorXd without = regression.residual_samples(others, k);
    squares[k] = spread(without - regression.residual_samples(found.value, k));
    samples[k] = static_cast<double>(without.size());
  });
  double total = 0.0;
  double length = 0.0;
  for (std::size_t k = 0; k < squares.size(); ++k) {
    total += squares[k];
    length += samples[k];
  }
  ReportedNumber out{"rms", std::sqrt(total / length), std::string(si_symbol(subject.quantity))};
  if (!(total > 0.0)) return out;
  double variance = 0.0;  // of the logarithm
  for (Index c = 0; c < count; ++c) {
    const std::size_t own =
        regression.coefficients()[static_cast<std::size_t>(first + c)].replicate;
    if (own == CoefficientName::kAll && count > 1) return out;
    const double share = own == CoefficientName::kAll ? 1.0 : squares[own] / total;
    const double relative =
        std::sqrt(found.covariance(first + c, first + c)) / found.value(first + c);
    variance += share * share * relative * relative;
  }
  return with_log_error(out, std::sqrt(variance));
}

// The first number in the channel's unit; where there is none, what its regressors add to the
// samples; else the first number of all.
ReportedNumber size_of(const FittedModel& model, std::size_t effect) {
  const std::string unit(si_symbol(model.regression.subject().quantity));
  const std::vector<ReportedNumber> numbers = fitted_numbers({model, effect});
  const auto in_unit = std::find_if(numbers.begin(), numbers.end(),
                                    [&](const auto& one) { return one.unit == unit; });
  if (in_unit != numbers.end()) return *in_unit;
  if (model.regression.first(effect) < model.regression.first(effect + 1))
    return size_in_samples(model, effect);
  return numbers.empty() ? ReportedNumber{} : numbers.front();
}

// Of noise: its deviation, or its first coefficient, which grows with the root of its power. Of a
// peak also where it is: "RES at 13.01 Hz".
struct NoiseSize {
  ReportedNumber size{};
  std::string place{};
};

NoiseSize size_of_noise(const FittedModel& model, std::size_t term) {
  const std::vector<ReportedNumber> all = noise_coefficients(model, term);
  const auto find = [&](Coefficient wanted) {
    const auto title = coefficient_units(wanted, model.regression.subject().quantity).title;
    return std::find_if(all.begin(), all.end(),
                        [&](const ReportedNumber& one) { return one.name == title; });
  };
  NoiseSize out;
  const auto deviation = find(Coefficient::kAmplitude);
  if (!all.empty()) out.size = deviation == all.end() ? all.front() : *deviation;
  if (const auto peak = find(Coefficient::kFrequency); peak != all.end())
    out.place = " at " + report::number(peak->value, 4, report::Digits::kPlain) + " Hz";
  if (const auto cutoff = find(Coefficient::kCutoff); cutoff != all.end())
    out.place = ", cut-off " + report::number(cutoff->value, 4, report::Digits::kPlain) + " Hz";
  return out;
}

// "RES + witness(b)": what one rung added, apart.
std::vector<std::string> parts_of(const std::string& added) {
  constexpr std::string_view kPlus = " + ";
  std::vector<std::string> out;
  std::size_t begin = 0;
  for (std::size_t end = 0; end != std::string::npos; begin = end + kPlus.size()) {
    end = added.find(kPlus, begin);
    out.push_back(added.substr(begin, end == std::string::npos ? end : end - begin));
  }
  return out;
}

// What the last model has of it, and how large that is.
struct Kept {
  std::string term{};
  std::string place{};
  std::optional<ReportedNumber> size{};
};

// The last model, each of whose terms is one rung's only.
class LastModel {
 public:
  explicit LastModel(const FittedModel& model)
      : model_(model),
        effects_taken_(model.regression.effects().size(), false),
        noise_taken_(model.fit.model.noise.terms.size(), false) {}

  /// Of what one rung added, `fitted` the noise of that. The size is that of an effect, else of
  /// noise.
  Kept kept(const std::string& added, const std::optional<Process>& fitted) {
    Kept out;
    std::optional<ReportedNumber> of_noise;
    for (const std::string& part : parts_of(added)) {
      const auto effect = take_effect(part);
      const auto noise = effect || !fitted ? std::nullopt : take_noise(part, *fitted);
      if (!effect && !noise) continue;  // it was dropped later
      out.term += fmt::format("{}{}", out.term.empty() ? "" : " + ", part);
      if (effect && !out.size) out.size = size_of(model_, *effect);
      if (!noise) continue;
      NoiseSize found = size_of_noise(model_, *noise);
      of_noise = std::move(found.size);
      out.place = std::move(found.place);
    }
    if (!out.size) out.size = of_noise;
    return out;
  }

 private:
  std::optional<std::size_t> take_effect(const std::string& part) {
    const std::vector<EffectTerm>& effects = model_.regression.effects();
    for (std::size_t e = 0; e < effects.size(); ++e) {
      if (effects_taken_[e] || print(effects[e]) != part) continue;
      effects_taken_[e] = true;
      return e;
    }
    return std::nullopt;
  }

  std::optional<std::size_t> take_noise(const std::string& part, const Process& fitted) {
    const Model& noise = model_.fit.model.noise;
    const std::optional<std::size_t> out = similar_term(noise, fitted, [&](std::size_t t) {
      return !noise_taken_[t] && printed_alone(noise.terms[t]) == part;
    });
    if (out) noise_taken_[*out] = true;
    return out;
  }

  const FittedModel& model_;
  std::vector<bool> effects_taken_;
  std::vector<bool> noise_taken_;
};

std::string sentence_of(const v1::LadderFinding& found, const std::string& place) {
  const v1::EffectParameter& size = found.size();
  std::string out = fmt::format("{}, {}{}", found.title(), found.term(), place);
  if (size.name().empty()) return out;
  std::string name = size.name();
  std::replace(name.begin(), name.end(), '_', ' ');
  const std::string value =
      size.has_lower()
          ? report::with_interval(size.value(), size.lower(), size.upper(), report::Digits::kPlain)
          : report::number(size.value(), 3, report::Digits::kPlain);
  return fmt::format("{}: {} {}{}", out, name, value, size.unit() == "1" ? "" : " " + size.unit());
}

}  // namespace

bool ModelsSeen::is_new(const FullModel& model) {
  std::multiset<std::string> terms;
  for (const Term& one : model.noise.terms) terms.insert(printed_alone(one));
  for (const EffectTerm& one : model.effects) terms.insert(print(one));
  return seen_.insert(std::move(terms)).second;
}

void add_findings(const FittedModel& last, const std::vector<std::optional<Process>>& noise,
                  v1::DiagnosisReport& to) {
  std::vector<int> kept;  // rungs
  for (int i = 1; i < to.ladder_size(); ++i) {
    for (const std::string& term : to.ladder(i).dropped()) {
      const auto gone = std::find_if(kept.begin(), kept.end(),
                                     [&](int one) { return to.ladder(one).added() == term; });
      if (gone != kept.end()) kept.erase(gone);
    }
    kept.push_back(i);
  }
  LastModel model(last);
  for (const int i : kept) {
    const v1::Rung& rung = to.ladder(i);
    const Kept left = model.kept(rung.added(), noise[static_cast<std::size_t>(i)]);
    if (!left.size) continue;  // it was dropped with the rung that added it
    v1::LadderFinding& found = *to.add_findings();
    found.set_effect(rung.effect());
    found.set_title(std::string(cause_info(rung.effect()).title));
    found.set_term(left.term);
    if (!left.size->name.empty()) *found.mutable_size() = message_of(*left.size);
    found.set_sentence(sentence_of(found, left.place));
  }
}

}  // namespace imunoise::study
