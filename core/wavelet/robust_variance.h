#pragma once

#include "core/wavelet/wavelet_variance.h"

namespace imunoise {

/// How hard outliers are pushed down, by the peers' names. Their equation for the tuning constant
/// has a sign error (+8 for -8 before the 18th moment), so that the estimators they call 0.6, 0.8,
/// 0.9 efficient are 0.727, 0.824, 0.902 efficient at the normal distribution. The constants are
/// theirs, for comparability; the interval uses the nominal figure, as theirs does, and is thus a
/// little wide.
enum class RobustEfficiency { k60, k80, k90 };

/// The nominal efficiency: 0.6, 0.8 or 0.9.
double nominal_efficiency(RobustEfficiency efficiency);

/// Robust wavelet variance: ν̂ solves mean_t χ(W_t/√ν) = E χ(N(0,1)) with χ(r) = r²(1 - r²/c²)⁴
/// inside |r| < c and 0 outside (Tukey's biweight; Guerrier et al. 2022, "Robust two-step
/// wavelet-based inference for time series models", eq. 5). The largest root is taken. Needs memory
/// for T doubles and one scale's coefficients per thread. Thread-safe; same precondition as
/// wavelet_variance().
WaveletVariance robust_wavelet_variance(const Signal& signal, const Scales& scales,
                                        RobustEfficiency efficiency, double confidence = 0.95,
                                        const Progress& progress = {});

}  // namespace imunoise
