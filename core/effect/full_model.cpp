#include "core/effect/full_model.h"

#include <algorithm>

namespace imunoise {
namespace {

std::string joined(std::string out, const std::vector<EffectTerm>& effects) {
  for (const EffectTerm& term : effects) out += (out.empty() ? "" : " + ") + print(term);
  return out;
}

}  // namespace

std::string print(const FullModel& model) { return joined(print(model.noise), model.effects); }

std::string print_with_values(const FullModel& model) {
  return joined(print_with_values(model.noise), model.effects);
}

std::vector<std::string> witnesses_of(const FullModel& model) {
  std::vector<std::string> out;
  for (const EffectTerm& term : model.effects) {
    const bool known = std::find(out.begin(), out.end(), term.witness) != out.end();
    if (!term.witness.empty() && !known) out.push_back(term.witness);
  }
  return out;
}

}  // namespace imunoise
