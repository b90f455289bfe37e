#pragma once

// The error that falls: what adding the true effect to a model does to its unexplained error and to
// the views of it, and that adding another does nothing.

#include <optional>
#include <string>
#include <vector>

#include "tests/hidden_effects/scoring/outcome.h"
#include "tests/hidden_effects/scoring/statistics.h"

namespace imunoise::hidden {

/// A term that has nothing to do with what was hidden, added to the model with the true one.
struct WrongTerm {
  std::string term;
  double gain = 0.0;  ///< held-out nats

  /// Whether that is more than chance: where a term is not there, the likelihood ratio of data to
  /// come has a mean of at most 1, so that more than 3 nats have a chance of at most e⁻³ = 5 %
  /// (Markov's inequality).
  bool beyond_chance() const { return gain > 3.0; }
};

/// How the error fell in one case.
struct ErrorFall {
  bool offered = false;   ///< the true effect is among the candidates
  double oracle = 0.0;    ///< held-out nats that an oracle gains
  double share = 0.0;     ///< of that
  std::string failing{};  ///< the view that failed most before; empty: none did (p ≥ 1e-3)
  bool at_floor = false;  ///< that view lies within its 95 % limit after it,
  bool as_clean = false;  ///< or no further off than of the same noise without the effect
  std::string risen{};    ///< another view that rose beyond its limit; empty: none
  std::vector<WrongTerm> wrong{};

  bool enough() const { return offered && share >= 0.8; }
  /// Whether a search could find it. The oracle's gain g scatters by √(2g), and a search needs
  /// ln(30/5 %) = 6.4 nats and about 4 for what it must fit: 95 % of sets have them from here on.
  bool can_be_found() const { return oracle >= 20.0; }
};

/// Adds the true effect of a diagnosed case, as the diagnosis offers it, and then wrong ones. The
/// oracle's fall: of an effect that shifts the mean, what the base's model gains on the same noise
/// without it (less what it costs not to know when noise jumps, see two_level_oracle.h, or the
/// phases of waves, see phase_price()); of an
/// effect that changes spectra, what its generator says (Injection::gained); else its expectation,
/// δ²/2, which a set of data misses by δ (standard deviation). Absent where nothing can be held
/// out.
std::optional<ErrorFall> error_fall(const Outcome& outcome);

/// The goals of one family.
struct FallScore {
  Share enough;    ///< at least 80 % of the oracle's fall; goal 95 %
  Share found;     ///< the same of those that can be found
  Share at_floor;  ///< of the views that failed; goal 90 %
  Share as_clean;  ///< these, or no further off than without the effect
  Share risen;     ///< another view rose; goal 0, a limit is passed once in 20 by chance
  Share wrong;     ///< wrong terms that gained beyond chance; at most 5 %
  std::vector<double> shares{};

  void add(const ErrorFall& fall);
  void add(const FallScore& other);
};

/// "line, δ = 12, seed 1: falls by 93 %, …"
std::string describe(const Outcome& outcome, const ErrorFall& fall);

}  // namespace imunoise::hidden
