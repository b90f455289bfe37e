#pragma once

// Models whose parameters follow a covariate. The covariate c is centred and scaled: the middle of
// its range is 0, the ends are ±1.

#include <vector>

#include "core/model/model.h"

namespace imunoise {

/// The search keeps slopes of exponential and logistic links within ± this: e^30 from end to end.
inline constexpr double kSteepestTrend = 15.0;

/// How parameter `index` of a process may follow a covariate, the customary way first.
std::vector<Link> possible_links(const ParameterInfo& info, std::size_t index);

/// A term's process at a covariate: each parameter moves along its link, and stays within its
/// bounds.
Process process_at(const Term& term, double covariate);
/// A model at a covariate, without trends.
Model model_at(const Model& model, double covariate);

/// What a term's wavelet variance gains at a covariate when parameter `index` moves by one unit on
/// the scale of its link (of its search where it follows nothing): dν/da. The slope's is c times as
/// much.
Eigen::ArrayXd change_with(const Term& term, std::size_t index, double covariate, HalfWidths m);

/// True when some parameter follows the covariate.
bool varies(const Term& term);
bool varies(const Model& model);

/// The model with every power that was not given following the covariate exponentially.
Model with_varying_powers(Model model);

}  // namespace imunoise
