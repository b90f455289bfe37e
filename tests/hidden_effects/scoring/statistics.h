#pragma once

// Shares with their bounds, and the strength at which nine in ten are found.

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/hidden_effects/generator/effect.h"

namespace imunoise::hidden {

/// So many of so many.
struct Share {
  std::size_t hits = 0;
  std::size_t count = 0;

  void add(bool hit) {
    ++count;
    if (hit) ++hits;
  }
  void add(const Share& other) {
    count += other.count;
    hits += other.hits;
  }
  double value() const;

  /// Clopper & Pearson's one-sided 95 % bounds; 0 and 1 when nothing was counted.
  double lower() const;
  double upper() const;
};

/// "17/20 = 85 %"
std::string to_string(const Share& share);

/// The median; absent when there is none.
std::optional<double> median(std::vector<double> values);

/// The δ at which 90 % are found, by linear interpolation of the shares over δ (increasing), made
/// monotone by pooling neighbours. The smallest δ when that is enough; absent when the largest is
/// not.
std::optional<double> strength_at_90(std::vector<std::pair<double, Share>> found);

/// The δ at which an observer who knows the form, but has to look through the whole of a search
/// that raises 5 % of false alarms, finds 90 %: a Bonferroni price for the 20 kinds of effect of
/// the catalogue and for every place, frequency or witness of this one.
double oracle_at_90(const HiddenEffect& effect, std::size_t samples, std::size_t replicates);

}  // namespace imunoise::hidden
