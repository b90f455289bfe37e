#pragma once

// The closed set of noise processes. Adding one: its file, its include, its name in the variant.

#include <optional>
#include <variant>

#include "core/process/ar1.h"
#include "core/process/ar2.h"
#include "core/process/averaging_filters.h"
#include "core/process/contract.h"
#include "core/process/flicker.h"
#include "core/process/gauss_markov.h"
#include "core/process/low_pass.h"
#include "core/process/moving_average.h"
#include "core/process/power_law.h"
#include "core/process/quantisation_noise.h"
#include "core/process/random_walk.h"
#include "core/process/rate_ramp.h"
#include "core/process/resonance.h"
#include "core/process/voigt.h"
#include "core/process/white_noise.h"

namespace imunoise {

template <NoiseProcess... P>
using ProcessVariant = std::variant<P...>;

using Process = ProcessVariant<WhiteNoise, QuantisationNoise, RandomWalk, RateRamp, Ar1, Ar2,
                               GaussMarkov, Resonance, Voigt, MovingAverage, MovingAverageFilter,
                               BartlettFilter, AnalogFilter, DigitalFilter, Flicker, PowerLaw>;

// The contract, on the variant.
const ProcessInfo& info(const Process& process);
std::vector<ParameterInfo> parameters(const Process& process);
std::vector<double> values(const Process& process);
void set_values(Process& process, std::span<const double> values);
Eigen::ArrayXd shape(const Process& process, HalfWidths m);
Eigen::ArrayXXd shape_jacobian(const Process& process, HalfWidths m);
double spectrum(const Process& process, const Frequency& f);
/// Of noise through a filter of finite memory; 0 of others.
int taps(const Process& process);
/// At many frequencies, cycles per sample. Where these are middles of bands and the spectrum may
/// have zeros, means over the bands.
Eigen::ArrayXd spectrum(const Process& process, const Frequencies& f);
SumCovariance sum_covariance(const Process& process);
std::vector<DerivedQuantity> derived(const Process& process, Hertz rate);
std::vector<std::vector<double>> scan(const Process& process, const Scales& scales);
/// Adds one realisation, from its stationary start. A process whose add_samples() draws for a known
/// length has that used; all others go sample by sample.
void add_samples(const Process& process, RandomStream& rng, std::span<double> out);

/// The whole number in NAME(n); 0 for processes that have none.
int structure(const Process& process);

/// Wavelet variance ν(m) = power · shape(m), in unit².
Eigen::ArrayXd variance(const Process& process, HalfWidths m);
/// dν/d(every parameter), scales × parameters, the power first.
Eigen::ArrayXXd jacobian(const Process& process, HalfWidths m);

/// Every process once, with unit power: what the grammar knows.
const std::vector<Process>& known_processes();
/// `process` with the given structure number; nothing when it has none or the number is out of
/// range.
std::optional<Process> with_structure(const Process& process, int number);

}  // namespace imunoise
