#pragma once

#include <string>

#include "core/support/result.h"
#include "imunoise/v1/live.pb.h"

namespace imunoise::study {

/// N, B and K of data sheets.
inline constexpr std::string_view kLiveModel = "WN + FN + RW";

/// Fits a model to the wavelet variances of a channel that is being recorded, and says for each of
/// its coefficients how much longer to record until half of its interval is at most `precision` of
/// its value. That is by 1/√time, once it is seen; until then record_longer() says when its
/// interval will leave zero. `stream` is the channel's. Too few scales for the model are its
/// trouble. Error: a model that cannot be read.
Result<v1::LiveParameters> live_parameters(const v1::LiveChannel& channel,
                                           const v1::LiveStream& stream, const std::string& model,
                                           double precision);

}  // namespace imunoise::study
