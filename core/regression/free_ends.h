#pragma once

#include "core/regression/fitted_model.h"

namespace imunoise {

/// How many samples at each end of a replicate a cosine transform takes for others than noise of
/// finite memory makes: half of what the longest filter of the noise averages. The transform sees a
/// series that its ends mirror, in which samples s and t (from 0) also have the covariance
/// γ(s + t + 1). With the first half of the filter's length unknown, no two others have that.
Eigen::Index free_ends(const Model& noise);

/// A fitted model whose samples at these ends are what the rest makes likeliest, instead of what
/// was measured, and fitted again. Near a zero of the filter's spectrum, 1/spectrum is large: what
/// does not belong into a mirrored series then looks like steps, bursts and jumps. Each such sample
/// costs half a nat. Without noise of finite memory, the model as it is.
FittedModel beside_free_ends(FittedModel fitted);

}  // namespace imunoise
