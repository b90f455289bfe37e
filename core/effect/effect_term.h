#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/effect/effect.h"
#include "core/support/units.h"

namespace imunoise {

/// One term of a model beside its noise: an effect with the values of its parameters.
struct EffectTerm {
  /// Parameters that are not named are absent.
  explicit EffectTerm(const Effect& of, std::string channel = {},
                      std::initializer_list<std::pair<std::string_view, double>> given = {});

  const Effect* effect;        ///< never null
  std::string witness;         ///< name of the channel; empty where the effect names none
  std::vector<double> values;  ///< one a parameter of the effect; a flag is 0 or 1

  double operator[](std::size_t parameter) const { return values[parameter]; }
  /// Precondition: the effect has a parameter of this name.
  double operator[](std::string_view parameter) const;
  void set(std::string_view parameter, double value);
  bool given(std::size_t parameter) const;

  friend bool operator==(const EffectTerm&, const EffectTerm&) = default;
};

/// `line(f=0.51, harmonics=3)`.
std::string print(const EffectTerm& term);

/// The term with numbers that are worth reading; see Rounding. `shape_error`: the standard error
/// that a search gave.
EffectTerm rounded(EffectTerm term, double shape_error, Hertz rate);

/// Reads what stands in the brackets of a term, `inside`, of the text `whole`. Error: what is
/// wrong, with `whole` before it.
Result<EffectTerm> parse_effect(const Effect& effect, std::string_view whole,
                                std::string_view inside);

}  // namespace imunoise
