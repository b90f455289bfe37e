#pragma once

#include <span>
#include <vector>

#include "core/integrity/integrity.h"
#include "core/signal/signal.h"

namespace imunoise {

/// The samples, SI, with each wrong one (in rising order) replaced by a draw that its neighbours
/// allow: sequential conditional simulation by simple kriging (Chilès & Delfiner 2012, §3.3 and
/// §7.3) of departures from the level of some hundred samples, with the autocovariance of the
/// signal itself, which keeps its second moments. A sample that was cut off is drawn from beyond
/// its value. Deterministic; where the neighbours determine nothing, a sample stays as it is.
std::vector<double> mended(const Signal& signal, std::span<const WrongSample> wrong);

}  // namespace imunoise
