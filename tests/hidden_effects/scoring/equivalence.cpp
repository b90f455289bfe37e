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
      // Many bursts are a power that wanders fast, and one cause makes both.
      {"bursts", {"variance_wander"}},
      {"variance_wander/fast", {"bursts"}},
      // One burst in one replicate, or a slow rise, is a power that changes for a while.
      {"bursts/one_replicate", {"variance_wander", "power_change"}},
      // A machine is at work: that its vibration is not steady is said by the other two names.
      {"line/few_periods", {"slow_cycle"}},
      {"switched_line", {"line"}},
      {"line/beating", {"switched_line", "harmonics"}},
      {"wandering_line", {"line", "resonance"}},
      // Slow noise by its spectrum, whose cause was not recorded.
      {"thermal_course",
       {"random_walk", "gauss_markov", "flicker", "second_order", "power_law", "temperature"}},
      {"warm_up/two_times", {"common_course"}},
      // A band of a power law is a band of flicker or of a Markov noise where it is faint.
      {"power_law", {"flicker", "gauss_markov", "second_order"}},
      // Behind a filter a resonance and the filter are one noise of the second order.
      {"resonance/filtered", {"second_order"}},
      {"gauss_markov/slow_neighbours", {"flicker", "random_walk", "second_order", "power_law"}},
      // A packet that does not arrive holds the output.
      {"duplicated_samples/held_packets", {"stuck", "lost_samples"}},
      // Rounding is there, and may be said.
      {"missing_codes", {"quantisation"}},
      {"printed_decimals", {"quantisation"}},
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
