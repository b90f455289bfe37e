#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/effect/effect_term.h"
#include "core/effect/evening.h"
#include "core/signal/signal.h"
#include "core/spectrum/banded_power.h"
#include "core/support/progress.h"
#include "core/support/shared_vector.h"
#include "core/support/units.h"

namespace imunoise {

/// Another channel that was recorded beside the one under study.
struct Witness {
  std::string name;
  Quantity quantity = Quantity::kUnknown;
  std::vector<SharedVector> samples;  ///< a replicate each, SI, mean zero
  std::vector<SharedVector> cosines;  ///< their cosine_transform()
  std::string unit{};                 ///< of the samples, where their quantity is unknown
  std::vector<double> levels{};       ///< means that were taken off, SI; empty: none were
};

/// A course that the power of noise may follow.
struct VarianceCourse {
  std::vector<SharedVector> samples{};  ///< one series a replicate of the subject
  std::vector<double> levels{};         ///< to be added to each; empty: nothing

  const SharedVector& operator[](std::size_t replicate) const { return samples[replicate]; }
  double level(std::size_t replicate) const { return levels.empty() ? 0.0 : levels[replicate]; }
};

/// Unit of a witness's samples; "1" where they have none.
std::string unit_of(const Witness& witness);
/// A unit in brackets where it is a quotient: "(rad/s)".
std::string in_brackets(const std::string& unit);
/// Unit of a quotient: "rad/s/K", "rad/s/(m/s²)", "1/K"; "1" where both are the same.
std::string per(const std::string& above, const std::string& below);

/// What one term's search found in the samples themselves and its text cannot hold, such as the
/// times of jumps.
struct Found {
  virtual ~Found() = default;
};

/// Where a replicate lies in what was recorded: a recording that is cut makes several.
struct Part {
  std::size_t recorded = 0;  ///< number of the recorded replicate, from 0
  Eigen::Index first = 0;    ///< the sample of it that is the replicate's first
};

/// Of replicates that are what was recorded.
std::vector<Part> uncut(std::size_t replicates);

/// The channel whose model is doubted: replicates and witnesses, and all their transforms, made
/// once.
struct Subject {
  Hertz rate;
  Quantity quantity = Quantity::kUnknown;
  std::vector<SharedVector> samples;  ///< a replicate each, of a quick_length(), SI, mean zero
  std::vector<SharedVector> cosines;  ///< their cosine_transform()
  std::vector<Part> parts;            ///< a replicate each, in the order of what was recorded
  std::vector<Witness> witnesses;
  std::vector<Witness> still{};  ///< recorded too, but they never change: no samples are kept
  /// What terms found in these replicates; see found_by().
  std::vector<std::pair<EffectTerm, std::shared_ptr<const Found>>> found{};
  /// Nats that numbers found in a replicate itself (outliers, jumps) would gain by chance; empty:
  /// none were sought.
  std::vector<double> own_nats{};
  /// Samples at each end of a replicate that are not what was measured, see free_ends().
  Eigen::Index free_ends = 0;
  /// Nats of each replicate by which its likelihood exceeds that of its samples as normal numbers,
  /// where a term changed their distribution; empty: none did.
  std::vector<double> reshaped_nats{};
  /// What made these samples of even power, in this order; see regressors_of().
  std::vector<std::shared_ptr<const Evening>> evenings{};

  std::size_t replicates() const { return samples.size(); }
  /// Samples in a replicate.
  Eigen::Index length(std::size_t replicate) const { return samples[replicate].size(); }
  double seconds(std::size_t replicate) const {
    return static_cast<double>(length(replicate)) / rate.value;
  }
  /// When a replicate begins, in s from the first sample of what was recorded.
  double begins(std::size_t replicate) const {
    return static_cast<double>(parts[replicate].first) / rate.value;
  }
  /// The replicate that a sample of a recorded one lies in, but for its first; none where it was
  /// cut.
  std::optional<std::size_t> around(std::size_t recorded, Eigen::Index sample) const;
  /// The witness of this name, or null.
  const Witness* find(const std::string& name) const;
  /// What a term found here; null where it has not been sought yet. T: the type that the term's
  /// effect keeps.
  template <class T>
  const T* found_by(const EffectTerm& term) const {
    for (const auto& [by, what] : found) {
      if (by == term) return static_cast<const T*>(what.get());
    }
    return nullptr;
  }
  /// Keeps what a term found, in place of what it found before.
  void keep(const EffectTerm& term, std::shared_ptr<const Found> what);
};

/// Names and replicates of one channel.
struct NamedChannel {
  std::string name;
  std::vector<Signal> replicates;
  std::string unit{};  ///< where their quantity is unknown
};

/// Precondition: at least one replicate, each of at least kFewestSamples samples; witnesses have
/// the same replicates; `parts` has one each, or none if nothing was cut. Stopped, it is not whole,
/// and of no use.
Subject make_subject(const std::vector<Signal>& replicates,
                     const std::vector<NamedChannel>& witnesses, std::vector<Part> parts = {},
                     const Progress& progress = {});

}  // namespace imunoise
