#include "daemon/catalogue/parameter_names.h"

namespace imunoise::catalogue {

bool is_called(const v1::ParameterHistory& one, const std::string& wanted) {
  std::string plain = one.parameter();
  if (plain == "σ") plain = "sigma";
  if (plain == "ζ") plain = "zeta";
  for (const std::string& name : {one.parameter(), plain}) {
    if (wanted == name || wanted == one.term() + "." + name) return true;
  }
  return wanted == one.title();
}

bool is_seen(const v1::HistoryPoint& point) {
  return point.has_lower() && point.has_upper() && point.lower() > 0.0 &&
         point.lower() < point.value() && point.value() < point.upper();
}

}  // namespace imunoise::catalogue
