#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/signal/signal.h"
#include "core/support/frequency.h"
#include "core/support/linear_algebra.h"
#include "core/support/units.h"

namespace imunoise {

/// Powers and cross powers of several series over frequency: products of their cosine_transform(),
/// averaged in bands.
struct CrossPower {
  Frequencies frequency;               ///< of each band, cycles per sample
  Eigen::ArrayXd count;                ///< coefficients in the band
  std::vector<Eigen::MatrixXd> power;  ///< a band, series × series, unit²
  std::size_t samples = 0;             ///< of each series
  Hertz rate;
};

/// Series shorter than this are not worth a spectrum.
inline constexpr std::size_t kFewestSamples = 16;

/// Its first quick_length() samples in SI units, less the first of them. Precondition: there are
/// kFewestSamples.
Eigen::VectorXd samples_of(const Signal& signal);
/// The first quick_length() samples of signals of equal length ≥ kFewestSamples, each less its
/// first one: samples × signals, in SI units.
Eigen::MatrixXd samples_of(std::span<const Signal> signals);

/// The columns of a matrix as signals, which borrow it.
std::vector<Signal> signals_of(const Eigen::MatrixXd& samples, Hertz rate);

/// Of series given as columns. Precondition: the number of rows is a quick_length().
CrossPower cross_power(const MatrixRef& series, Hertz rate);

}  // namespace imunoise
