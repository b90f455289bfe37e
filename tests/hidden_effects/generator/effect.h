#pragma once

// Hidden effects: what they do to a scene, and how strongly.

#include <optional>
#include <string>
#include <vector>

#include "tests/hidden_effects/generator/scene.h"

namespace imunoise::hidden {

/// A number of an effect, as it was put in.
struct TrueParameter {
  std::string name;  ///< "frequency_hz", "coefficient", …
  double value = 0.0;
  std::string unit;  ///< SI
};

/// What was put in.
struct Injection {
  double delta = 0.0;     ///< The oracle's non-centrality; see oracle.h.
  double informed = 0.0;  ///< The same of an oracle who is told the base's levels as well.
  std::vector<TrueParameter> parameters;
  /// Nats by which the true spectra exceed, on these very data, the nearest of the base's noises;
  /// absent where the effect does not change powers.
  std::optional<double> gained{};
  /// Nats that it costs an observer not to be told what each replicate has of its own (phases).
  double untold = 0.0;
};

/// What is asked of the tool.
enum class Kind {
  kCatalogue,  ///< To be named.
  kIntegrity,  ///< A defect of the samples: certain to be seen by who looks for it, δ is a count.
  kOutside,    ///< Not in the catalogue: to be noticed and not named.
  kForeign,    ///< Outside the catalogue's exact shapes: its family is to be named.
  kHarmless,   ///< No defect: no cause is to be named.
};

/// How the search-adjusted oracle and the targets see it.
enum class Family { kShort, kLine, kWitness, kSlow, kLocal };

/// An effect, or a variant of one.
struct HiddenEffect {
  std::string id;       ///< Of the catalogue of effects; its own when outside.
  std::string variant;  ///< "lagged", "slow", …; empty when there is one only.
  Kind kind = Kind::kCatalogue;
  Family family = Family::kShort;
  Base base = Base::kWhiteWalk;  ///< What it is hidden in.
  double rate_hz = 100.0;
  std::string witness;  ///< The channel that shows its cause; empty when none does.

  /// Hides the effect in gyro_x (and what else it touches) at the given δ.
  Injection (*hide)(Scene& scene, double delta) = nullptr;

  std::string name() const { return variant.empty() ? id : id + "/" + variant; }
};

/// A family outside the catalogue's exact shapes.
HiddenEffect foreign(std::string id, std::string variant,
                     Injection (*hide)(Scene& scene, double delta));

/// Every effect of the blind trial.
const std::vector<HiddenEffect>& hidden_effects();

/// Those of one file each.
std::vector<HiddenEffect> noise_effects();
std::vector<HiddenEffect> periodic_effects();
std::vector<HiddenEffect> slow_effects();
std::vector<HiddenEffect> witness_effects();
std::vector<HiddenEffect> neighbour_effects();
std::vector<HiddenEffect> irregular_effects();
std::vector<HiddenEffect> integrity_effects();
std::vector<HiddenEffect> outside_effects();
std::vector<HiddenEffect> foreign_powers();
std::vector<HiddenEffect> foreign_waves();
std::vector<HiddenEffect> foreign_courses();
std::vector<HiddenEffect> foreign_spectra();
std::vector<HiddenEffect> foreign_couplings();
std::vector<HiddenEffect> foreign_samples();

/// The effect of that name ("temperature/lagged"), or null.
const HiddenEffect* find_effect(std::string_view name);

}  // namespace imunoise::hidden
