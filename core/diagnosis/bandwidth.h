#pragma once

#include "core/model/model.h"

namespace imunoise {

/// Whether a resonance or second-order autoregression has more than half of its critical damping:
/// two lags in a row, as a filter of second order has.
bool hardly_rings(const Process& process);

/// Whether noise forgets within twenty samples: what a filter of the sensor may have made.
bool is_fast(const Process& process);

/// Whether noise of a model is the sensor's bandwidth: it is fast, and fast noise left hardly any
/// white noise beside it.
bool is_bandwidth(const Process& one, const Model& noise);

}  // namespace imunoise
