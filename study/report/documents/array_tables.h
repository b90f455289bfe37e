#pragma once

#include <string>

#include "imunoise/v1/array.pb.h"
#include "study/report/documents/document.h"
#include "study/words/number.h"

namespace imunoise::report {

using ArrayParameters = google::protobuf::RepeatedPtrField<v1::ArrayParameter>;
using SensorBudgets = google::protobuf::RepeatedPtrField<v1::SensorBudget>;

/// "a, b, c".
std::string joined(const google::protobuf::RepeatedPtrField<std::string>& names);

/// The parameters of an array's noise, but those that array_correlations() shows.
Table array_parameters(const std::string& title, const ArrayParameters& parameters, Digits digits);
/// How what two sensors have of a process is correlated; without rows when there is none.
Table array_correlations(const ArrayParameters& parameters, Digits digits);
/// Shares of what explains each sensor, or whatever they are called, one column a term.
Table sensor_budgets(const std::string& title, const std::string& of, const SensorBudgets& budgets);

}  // namespace imunoise::report
