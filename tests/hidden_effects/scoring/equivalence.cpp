#include "tests/hidden_effects/scoring/equivalence.h"

#include <map>

namespace imunoise::hidden {

std::vector<std::string> right_names(const HiddenEffect& effect, bool withheld) {
  static const std::map<std::string, std::vector<std::string>> kAlso = {
      // A first-order filter over white noise is a Markov noise of a few samples (SCIENCE §2).
      {"low_pass", {"gauss_markov"}},
      {"gauss_markov/short", {"low_pass"}},
      // Above white noise and below a walk only a band of 1/f is left, and one Markov noise fills a
      // band; a Markov noise that is slower than most of a recording is a walk in it.
      {"flicker", {"gauss_markov"}},
      {"gauss_markov/long", {"flicker"}},
      // The mains fold to a line like any other; of faint harmonics only the strongest line shows.
      {"mains_alias", {"line"}},
      {"harmonics", {"line"}},
      // With two gyros alone, a shaking of both and a leak from one into the other are one
      // coherence.
      {"common_vibration", {"cross_axis"}},
      {"cross_axis", {"common_vibration"}},
      // A bench that rocks is a motion that two sensors share.
      {"tilt", {"common_vibration"}},
      // Held samples are duplicates, many in a row.
      {"stuck", {"duplicated_samples"}},
  };
  if (effect.kind == Kind::kOutside || (withheld && !effect.witness.empty())) return {};
  std::vector<std::string> out = {effect.id};
  for (const std::string& key : {effect.id, effect.name()}) {
    const auto found = kAlso.find(key);
    if (found == kAlso.end()) continue;
    out.insert(out.end(), found->second.begin(), found->second.end());
    break;
  }
  return out;
}

}  // namespace imunoise::hidden
