#pragma once

// Seeded random streams. Every random number of the house comes from a printed seed.

#include <boost/random/normal_distribution.hpp>
#include <cstdint>
#include <initializer_list>
#include <random>
#include <vector>

namespace imunoise {

/// One stream of standard normal numbers (ziggurat; the same numbers on every platform).
class RandomStream {
 public:
  /// The stream that `seed` and a path of indices (replicate, term, ...) name. Different paths give
  /// streams that are independent for all practical purposes.
  explicit RandomStream(std::uint64_t seed, std::initializer_list<std::uint32_t> path = {}) {
    std::vector<std::uint32_t> key = {static_cast<std::uint32_t>(seed),
                                      static_cast<std::uint32_t>(seed >> 32U)};
    key.insert(key.end(), path);
    std::seed_seq sequence(key.begin(), key.end());
    engine_.seed(sequence);
  }

  /// The next N(0, 1) number.
  double normal() { return normal_(engine_); }

  /// The engine, for other distributions.
  std::mt19937_64& engine() { return engine_; }

 private:
  std::mt19937_64 engine_;
  boost::random::normal_distribution<double> normal_;
};

}  // namespace imunoise
