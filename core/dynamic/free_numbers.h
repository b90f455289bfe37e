#pragma once

#include <vector>

#include "core/model/trend.h"

namespace imunoise {

/// One number that a fit with trends can move.
struct FreeNumber {
  enum class Kind {
    kPower,  ///< a power, in unit²: constant, or one that follows the covariate but is zero
    kFirst,  ///< a linear power at the lower end of the covariate, in unit²
    kLast,   ///< at the upper end
    kLevel,  ///< a parameter in the middle of the covariate's range, on the scale of its link
    kSlope,  ///< its slope
  };
  std::size_t term;
  std::size_t parameter;
  Kind kind;
  bool at_zero = false;  ///< a power that the fit put at zero
};

/// The numbers of a fitted model: all that are free, without those at a bound of the search and
/// those of terms without power.
std::vector<FreeNumber> free_numbers(const Model& model);

/// dν / d(number) at a covariate: scales × numbers.
Eigen::MatrixXd jacobian(const Model& model, const std::vector<FreeNumber>& numbers,
                         double covariate, HalfWidths m);

/// d(parameter of a term at a covariate) / d(number).
double speed(const Model& model, const FreeNumber& number, double covariate);

/// Value of a power's number, and the model with it changed.
double power_of(const Model& model, const FreeNumber& number);
Model with_power(Model model, const FreeNumber& number, double value);

}  // namespace imunoise
