#include "study/report/view/coefficient_words.h"

namespace imunoise::report {
namespace {

// Numbers of a coefficient in one system of units.
struct Numbers {
  double value;
  double lower;
  double upper;
  bool interval;
  std::string unit;  // after a blank; empty for a pure number
};

Numbers numbers_of(const v1::Coefficient& one, UnitSystem system) {
  const bool si = system == UnitSystem::kSi || one.datasheet_unit().empty();
  const std::string& unit = si ? one.unit() : one.datasheet_unit();
  return {si ? one.value() : one.datasheet_value(), si ? one.lower() : one.datasheet_lower(),
          si ? one.upper() : one.datasheet_upper(), one.has_lower() && one.has_upper(),
          unit.empty() || unit == "1" ? "" : " " + unit};
}

}  // namespace

std::string value_words(const v1::Coefficient& one, Digits digits, UnitSystem system) {
  const Numbers n = numbers_of(one, system);
  return (n.interval ? with_interval(n.value, n.lower, n.upper, digits)
                     : number(n.value, 3, digits)) +
         n.unit;
}

std::string short_words(const v1::Coefficient& one, Digits digits, UnitSystem system) {
  const Numbers n = numbers_of(one, system);
  const bool bound = n.interval && !(n.lower > 0.0) && n.upper > 0.0;
  return (bound ? "at most " + number(n.upper, 3, digits) : number(n.value, 3, digits)) + n.unit;
}

std::string short_words(const google::protobuf::RepeatedPtrField<v1::Coefficient>& all,
                        Digits digits) {
  std::string out;
  for (const v1::Coefficient& one : all)
    out += (out.empty() ? "" : ", ") + one.symbol() + " " + short_words(one, digits);
  return out;
}

std::string short_words(const google::protobuf::RepeatedPtrField<v1::Term>& terms, Digits digits) {
  std::string out;
  for (const v1::Term& term : terms) {
    const std::string words = short_words(term.coefficients(), digits);
    out += (out.empty() || words.empty() ? "" : ", ") + words;
  }
  return out;
}

}  // namespace imunoise::report
