#include "study/report/documents/array_tables.h"

namespace imunoise::report {

std::string joined(const google::protobuf::RepeatedPtrField<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

Table array_parameters(const std::string& title, const ArrayParameters& parameters, Digits digits) {
  Table out{title, {"term", "sensors", "", "value", "interval", "unit"}, {}};
  for (const v1::ArrayParameter& one : parameters) {
    if (one.has_correlation()) continue;
    const double upper = one.has_upper() ? one.upper() : one.lower();
    out.rows.push_back({one.term(), joined(one.sensors()), one.parameter(),
                        rounded(one.value(), one.lower(), upper, digits),
                        interval(one.value(), one.lower(), upper, digits),
                        one.unit() == "1" ? "" : one.unit()});
  }
  return out;
}

Table array_correlations(const ArrayParameters& parameters, Digits digits) {
  Table out{"Correlation of a process between sensors",
            {"term", "sensors", "correlation", "interval"},
            {}};
  for (const v1::ArrayParameter& one : parameters) {
    if (!one.has_correlation()) continue;
    out.rows.push_back(
        {one.term(), joined(one.sensors()),
         rounded(one.correlation(), one.correlation_lower(), one.correlation_upper(), digits),
         interval(one.correlation(), one.correlation_lower(), one.correlation_upper(), digits)});
  }
  return out;
}

Table sensor_budgets(const std::string& title, const std::string& of,
                     const SensorBudgets& budgets) {
  Table out{title, {of}, {}};
  for (const v1::SensorBudget& one : budgets) {
    std::vector<std::string> row = {one.sensor()};
    for (const v1::TermShare& term : one.terms()) {
      if (out.rows.empty()) out.head.push_back(term.term());
      row.push_back(percent(term.share()));
    }
    out.rows.push_back(std::move(row));
  }
  return out;
}

}  // namespace imunoise::report
