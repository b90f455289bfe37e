#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/signal/signal.h"
#include "core/spectrum/banded_power.h"
#include "core/support/progress.h"
#include "core/support/units.h"

namespace imunoise {

/// Another channel that was recorded beside the one under study.
struct Witness {
  std::string name;
  Quantity quantity = Quantity::kUnknown;
  std::vector<Eigen::VectorXd> samples;  ///< a replicate each, SI, mean zero
  std::vector<Eigen::VectorXd> cosines;  ///< their cosine_transform()
};

/// A replicate that jumps between two levels, -½ and ½.
struct TwoLevelCourse {
  double start = -0.5;                ///< the first level
  std::vector<Eigen::Index> jumps{};  ///< samples before which it jumps, rising
  double log_places = 0.0;            ///< logarithm of how many courses have as many jumps
  Eigen::VectorXd cosines{};          ///< its cosine_transform()
};

/// The channel whose model is doubted: replicates and witnesses, and all their transforms, made
/// once.
struct Subject {
  Hertz rate;
  Quantity quantity = Quantity::kUnknown;
  std::vector<Eigen::VectorXd> samples;  ///< a replicate each, of a quick_length(), SI, mean zero
  std::vector<Eigen::VectorXd> cosines;  ///< their cosine_transform()
  std::vector<Witness> witnesses;
  std::vector<Witness> still{};  ///< recorded too, but they never change: no samples are kept
  std::vector<TwoLevelCourse> courses{};  ///< a replicate each, once found; see with_two_levels()
  /// Nats that numbers found in a replicate itself (outliers, jumps) would gain by chance; empty:
  /// none were sought.
  std::vector<double> own_nats{};

  std::size_t replicates() const { return samples.size(); }
  /// Samples in a replicate.
  Eigen::Index length(std::size_t replicate) const { return samples[replicate].size(); }
  double seconds(std::size_t replicate) const {
    return static_cast<double>(length(replicate)) / rate.value;
  }
  /// The witness of this name, or null.
  const Witness* find(const std::string& name) const;
};

/// Names and replicates of one channel.
struct NamedChannel {
  std::string name;
  std::vector<Signal> replicates;
};

/// Precondition: at least one replicate, each of at least kFewestSamples samples; witnesses have
/// the same replicates. Stopped, it is not whole, and of
/// no use.
Subject make_subject(const std::vector<Signal>& replicates,
                     const std::vector<NamedChannel>& witnesses, const Progress& progress = {});

}  // namespace imunoise
