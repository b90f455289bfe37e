#include "study/report/documents/effect_rows.h"

#include <fmt/format.h>

#include <algorithm>

namespace imunoise::report {
namespace {

// A count, a place or a time, which is known as it stands: "4", "150.1".
std::string as_it_stands(double value, Digits digits) {
  std::string out = number(value, 5, digits);
  if (out.find('.') == std::string::npos ||
      out.find_first_not_of("-0123456789.") != std::string::npos)
    return out;
  out.erase(out.find_last_not_of('0') + 1);
  if (out.back() == '.') out.pop_back();
  return out;
}

}  // namespace

std::string value_of(const v1::EffectParameter& one, Digits digits) {
  std::string out = one.has_lower() ? with_interval(one.value(), one.lower(), one.upper(), digits)
                                    : as_it_stands(one.value(), digits);
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
