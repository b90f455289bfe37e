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

Model freed(Model model) {
  for (Term& term : model.terms) term.given.assign(term.given.size(), false);
  return model;
}

}  // namespace

void Comparisons::add(const std::vector<Model>& models, const Progress& progress) {
  const std::size_t before = fits_.size();
  for (std::size_t c = 0; c < models.size() && !progress.stopped(); ++c) {
    const auto at = static_cast<double>(c) / static_cast<double>(models.size());
    fits_.push_back(mugmwm(models[c], measured_, Weighting::kFull, progress.part(at, at)));
  }
  if (parts_.empty()) return;
  held_.resize(fits_.size());
  for_each_index(fits_.size() - before, [&](std::size_t i) {
    held_[before + i] = held_out_fit(fits_[before + i].model, parts_);
  });
}

std::size_t Comparisons::best() const { return simplest_of_best(held_); }

bool Comparisons::is_known(const Model& model) const {
  return std::any_of(fits_.begin(), fits_.end(),
                     [&](const Estimate& one) { return kinds_of(one.model) == kinds_of(model); });
}

std::vector<Model> Comparisons::near(const Model& model) const {
  std::vector<Model> out;
  const auto offer = [&](Model one) {
    const bool twice = std::any_of(out.begin(), out.end(), [&](const Model& other) {
      return kinds_of(other) == kinds_of(one);
    });
    if (!twice && !is_known(one) && can_be_fitted(one, {measured_.begin(), measured_.end()}))
      out.push_back(std::move(one));
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
    const std::size_t from = best();
    const std::vector<Model> models = near(fits_[from].model);
    if (models.empty()) return;
    add(models, progress.part(static_cast<double>(round) / kMostRounds,
                              static_cast<double>(round + 1) / kMostRounds));
    if (best() == from) return;
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
