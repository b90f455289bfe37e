#include "study/analysis/compared_models.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/support/parallel.h"
#include "study/analysis/prepare.h"

namespace imunoise::study {
namespace {

constexpr int kMostRounds = 4;

std::multiset<std::size_t> kinds_of(const Model& model) {
  std::multiset<std::size_t> out;
  for (const Term& term : model.terms) out.insert(term.process.index());
  return out;
}

const Model& largest(const std::vector<Model>& models) {
  return *std::max_element(models.begin(), models.end(), [](const Model& a, const Model& b) {
    return free_parameters(a) < free_parameters(b);
  });
}

Model freed(Model model) {
  for (Term& term : model.terms) term.given.assign(term.given.size(), false);
  return model;
}

}  // namespace

void Comparisons::add(const std::vector<Model>& models, const Progress& progress) {
  const std::size_t before = models_.size();
  models_.insert(models_.end(), models.begin(), models.end());
  if (parts_.empty()) return;
  const Progress silent({}, progress.stop_token());
  if (weight_roots_.empty())
    weight_roots_ = mugmwm(largest(models), measured_, Weighting::kFull, silent).weight_roots;
  held_.resize(models_.size());
  for_each_index(models.size(), [&](std::size_t i) {
    if (silent.stopped()) return;
    const Problem problem = tied_problem(models[i], measured_, weight_roots_);
    held_[before + i] = held_out_fit(sorted(minimise(problem, silent).model), parts_);
  });
  progress.report(1.0);
}

bool Comparisons::is_known(const Model& model) const {
  return std::any_of(models_.begin(), models_.end(),
                     [&](const Model& one) { return kinds_of(one) == kinds_of(model); });
}

std::vector<Model> Comparisons::near(const Model& model) const {
  std::vector<Model> out;
  const auto offer = [&](Model one) {
    const bool twice = std::any_of(out.begin(), out.end(), [&](const Model& other) {
      return kinds_of(other) == kinds_of(one);
    });
    if (!twice && !is_known(one) && can_be_fitted(one, measured_)) out.push_back(std::move(one));
  };
  for (const Process& process :
       {Process(Flicker{}), Process(QuantisationNoise{}), Process(RateRamp{})}) {
    if (kinds_of(model).contains(process.index())) continue;
    Model more = freed(model);
    more.terms.emplace_back(process);
    offer(more);
    for (std::size_t t = 0; t < model.terms.size(); ++t) {
      Model other = more;
      other.terms.erase(other.terms.begin() + static_cast<std::ptrdiff_t>(t));
      offer(other);
    }
  }
  return out;
}

void Comparisons::search_on(const Progress& progress) {
  for (int round = 0; round < kMostRounds && !held_.empty() && !progress.stopped(); ++round) {
    const std::size_t from = best_place();
    const std::vector<Model> models = near(held_[from].model);
    if (models.empty()) return;
    add(models, progress.part(static_cast<double>(round) / kMostRounds,
                              static_cast<double>(round + 1) / kMostRounds));
    if (progress.stopped() || best_place() == from) return;
  }
}

std::optional<std::string> quantisation_note(const Model& fitted) {
  for (const Term& term : fitted.terms) {
    const auto* markov = std::get_if<Ar1>(&term.process);
    if (markov == nullptr || !(values(term.process)[1] < 0.0)) continue;
    return fmt::format(
        "The AR1 has a negative phi ({:.3g}): neighbouring samples move against each other. "
        "Quantisation noise does so; compare the model with QN in the place of that AR1.",
        values(term.process)[1]);
  }
  return std::nullopt;
}

}  // namespace imunoise::study
