#include "core/effect/full_model.h"

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

}  // namespace imunoise
