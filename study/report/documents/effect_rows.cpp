#include "study/report/documents/effect_rows.h"

#include <fmt/format.h>

#include <algorithm>

namespace imunoise::report {

std::string value_of(const v1::EffectParameter& one, Digits digits) {
  std::string out = one.has_lower() ? with_interval(one.value(), one.lower(), one.upper(), digits)
                                    : number(one.value(), 5, digits);
  return one.unit() == "1" ? out : out + " " + one.unit();
}

std::vector<std::vector<std::string>> effect_rows(
    const google::protobuf::RepeatedPtrField<v1::FittedEffect>& effects, Digits digits) {
  std::vector<std::vector<std::string>> out;
  for (const v1::FittedEffect& effect : effects) {
    constexpr int kMostNumbers = 4;
    if (effect.parameters_size() == 0) out.push_back({effect.term(), "", ""});
    for (int i = 0; i < std::min(kMostNumbers, effect.parameters_size()); ++i) {
      const v1::EffectParameter& one = effect.parameters(i);
      out.push_back({i == 0 ? effect.term() : "", one.name(), value_of(one, digits)});
    }
    if (effect.parameters_size() > kMostNumbers)
      out.push_back(
          {"", fmt::format("and {} more", effect.parameters_size() - kMostNumbers), "in the JSON"});
  }
  return out;
}

}  // namespace imunoise::report
