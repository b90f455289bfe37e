#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/effect/effect.h"
#include "core/model/syntax.h"
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

/// The term without its sizes (its truth): what a fit takes.
EffectTerm shape_of(EffectTerm term);

/// True of what changes the noise itself, rather than adds to the samples.
bool changes_noise(const Effect& effect);

/// Reads a term of `text` as an effect. Error: model_error() at what is wrong.
Result<EffectTerm> read_effect(const Effect& effect, const WrittenTerm& written,
                               std::string_view text);

}  // namespace imunoise
