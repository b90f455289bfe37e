#pragma once

// Subjects made in memory for the tests of the diagnosis.

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "core/diagnosis/diagnose.h"
#include "core/effects/parse_full_model.h"
#include "core/effects/simulate_effects.h"
#include "core/spectrum/cosine_transform.h"

namespace imunoise {

inline double wave(double hertz, double s) { return std::sin(2.0 * std::numbers::pi * hertz * s); }

/// The same through a first-order lag of `lag` seconds: lower, and late.
inline double lagged_wave(double hertz, double lag, double s) {
  const double w = 2.0 * std::numbers::pi * hertz;
  return wave(hertz, s - std::atan(w * lag) / w) / std::sqrt(1.0 + w * w * lag * lag);
}

/// Something that a test adds to a replicate: a sample's value from its time in s.
using Addition = std::function<double(std::size_t replicate, double seconds)>;

struct MadeSubject {
  std::string model = "WN(sigma2=1) + RW(gamma2=1e-5)";
  std::size_t samples = 8192;
  std::size_t replicates = 4;
  std::size_t shorter = 0;  ///< samples by which each replicate is shorter than the one before
  std::size_t first = 0;    ///< samples of the first replicate, where it has its own length
  std::uint64_t seed = 1;
  Addition added = [](std::size_t, double) { return 0.0; };
  Addition temperature{};  ///< a witness "temperature", K, where there is one
  Quantity witness = Quantity::kTemperature;
};

inline std::shared_ptr<const Subject> subject_of(const MadeSubject& made) {
  constexpr Hertz kRate{50.0};
  const Model noise = *parse_model(made.model, kRate);
  std::vector<std::vector<double>> series;
  std::vector<std::vector<double>> witness;
  for (std::size_t k = 0; k < made.replicates; ++k) {
    const bool own = k == 0 && made.first > 0;
    const std::size_t samples = own ? made.first : made.samples - k * made.shorter;
    series.push_back(simulate(noise, samples, made.seed, static_cast<std::uint32_t>(k)));
    witness.emplace_back(samples);
    for (std::size_t t = 0; t < samples; ++t) {
      const double seconds = static_cast<double>(t) / kRate.value;
      series.back()[t] += made.added(k, seconds);
      if (made.temperature) witness.back()[t] = made.temperature(k, seconds);
    }
  }
  std::vector<Signal> replicates;
  NamedChannel temperature{"temperature", {}};
  for (std::size_t k = 0; k < made.replicates; ++k) {
    replicates.emplace_back(std::span<const double>(series[k]), kRate, Quantity::kAngularRate);
    temperature.replicates.emplace_back(std::span<const double>(witness[k]), kRate, made.witness);
  }
  std::vector<NamedChannel> witnesses;
  if (made.temperature) witnesses.push_back(temperature);
  return std::make_shared<const Subject>(make_subject(replicates, witnesses));
}

/// A subject with effects of given size in it.
inline std::shared_ptr<const Subject> with_effects(const Subject& plain,
                                                   const std::vector<EffectTerm>& terms,
                                                   std::uint64_t seed) {
  auto out = std::make_shared<Subject>(plain);
  for (std::size_t k = 0; k < out->replicates(); ++k) {
    Eigen::VectorXd samples = out->samples[k];
    simulate_effects(terms, *out, k, seed, samples);
    samples.array() -= samples.mean();
    out->cosines[k] = cosine_transform(samples);
    out->samples[k] = std::move(samples);
  }
  return out;
}

/// The fit of a model, from the values that noise of the tests has.
inline FittedModel fitted(std::shared_ptr<const Subject> subject,
                          const std::string& text = "WN + RW") {
  FullModel model = *parse_full_model(text, subject->rate);
  for (Term& term : model.noise.terms) {
    std::vector<double> v = values(term.process);
    v[0] = std::holds_alternative<RandomWalk>(term.process) ? 2e-5 : 0.8;
    set_values(term.process, v);
  }
  return fit_full_model(std::move(subject), model);
}

}  // namespace imunoise
