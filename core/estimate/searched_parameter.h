#pragma once

// A parameter of a process on the scale on which likelihoods are searched: a power as it is, a
// shape on its ParameterScale.

#include <algorithm>
#include <vector>

#include "core/process/parameter_scale.h"
#include "core/process/process.h"

namespace imunoise {

inline double searched(const Process& process, std::size_t parameter) {
  const double value = values(process)[parameter];
  if (parameter == 0) return value;
  return ParameterScale(parameters(process)[parameter], parameter).to_scale(value);
}

inline void set_searched(Process& process, std::size_t parameter, double at) {
  std::vector<double> v = values(process);
  v[parameter] = at;
  if (parameter > 0) {
    const ParameterInfo about = parameters(process)[parameter];
    v[parameter] =
        std::clamp(ParameterScale(about, parameter).to_value(at), about.lower, about.upper);
  }
  set_values(process, v);
}

/// d value / d parameter on that scale.
inline double searched_scale(const Process& process, std::size_t parameter) {
  if (parameter == 0) return 1.0;
  return ParameterScale(parameters(process)[parameter], parameter)
      .slope(values(process)[parameter]);
}

/// d spectrum / d parameter on that scale.
inline Eigen::ArrayXd searched_slope(const Process& process, std::size_t parameter,
                                     const Frequencies& frequency) {
  constexpr double kStep = 1e-4;
  const double at = searched(process, parameter);
  const auto spectrum_at = [&](double to) -> Eigen::ArrayXd {
    Process moved = process;
    set_searched(moved, parameter, to);
    return spectrum(moved, frequency);
  };
  if (parameter == 0) return spectrum_at(1.0);
  return (spectrum_at(at + kStep) - spectrum_at(at - kStep)) / (2.0 * kStep);
}

}  // namespace imunoise
