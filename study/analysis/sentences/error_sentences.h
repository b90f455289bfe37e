#pragma once

// How far a model is from the data, in each view of them.

#include <string>
#include <vector>

#include "core/diagnosis/views/error_views.h"
#include "core/diagnosis/views/left_over.h"
#include "imunoise/v1/diagnosis.pb.h"

namespace imunoise::study {

/// "far beyond chance", from the chance that a true model deviates as much.
std::string significance_words(double p);

/// The error views of a fitted model with a sentence each: where it is worst, how large that is,
/// and how sure. `left`: left_over() of it; `replicates` are the names of all.
std::vector<v1::ErrorView> views_of(const FittedModel& trial, const LeftOver& left,
                                    const MisfitReport& misfit,
                                    const std::vector<std::string>& replicates);

}  // namespace imunoise::study
