#pragma once

// How users name parameters, and what of a parameter a calibration saw.

#include <string>

#include "imunoise/v1/catalogue.pb.h"

namespace imunoise::catalogue {

/// "N", "sigma", "AR1.T" or "angle random walk".
bool is_called(const v1::ParameterHistory& one, const std::string& wanted);

/// An interval on both sides of the value.
bool is_seen(const v1::HistoryPoint& point);

}  // namespace imunoise::catalogue
