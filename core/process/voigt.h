#pragma once

#include <vector>

#include "core/process/resonance.h"

namespace imunoise {

/// A resonance whose frequency is spread: the sum of independent damped oscillations (Resonance) at
/// ω + s·x_j, x_j = -2.8, -2.4 .. 2.8, driven by variances σ²w_j, w_j ∝ exp(-x_j²/2), Σw_j = 1. Its
/// line is a Lorentzian smeared by a Gaussian of standard deviation s (Voigt 1912); where the
/// damping -ln r falls below 0.4 s, single oscillations begin to show.
struct Voigt {
  double sigma2 = 1.0;   ///< of all that drives it
  double r = 0.9;        ///< decay per sample of each oscillation, 0 < r < 1
  double omega = 1.0;    ///< middle frequency, rad per sample, 0 < ω < π
  double spread = 0.05;  ///< s, rad per sample

  static constexpr ProcessInfo kInfo{"VOIGT", "spread resonance",
                                     "A resonance whose frequency differs from place to place or "
                                     "wanders: parts of unequal size, a drive that hunts."};
  friend bool operator==(const Voigt&, const Voigt&) = default;

  std::vector<ParameterInfo> parameters() const;
  std::vector<double> values() const { return {sigma2, r, omega, spread}; }
  void set_values(std::span<const double> v) {
    sigma2 = v[0];
    r = v[1];
    omega = v[2];
    spread = v[3];
  }
  /// The oscillations that it is the sum of; one beyond 0 or π as its mirror image.
  std::vector<Resonance> parts() const;
  Eigen::ArrayXd shape(HalfWidths m) const;
  Eigen::ArrayXXd shape_jacobian(HalfWidths m) const;
  double spectrum(const Frequency& f) const;
  Eigen::ArrayXd spectra(const Frequencies& f) const;
  SumCovariance sum_covariance() const;
  std::vector<DerivedQuantity> derived(Hertz rate) const;
  std::vector<std::vector<double>> scan(const Scales& scales) const;

  class Recursion {
   public:
    double next(RandomStream& rng);

   private:
    friend Voigt;
    std::vector<SecondOrderRecursion> parts_;
  };
  Recursion recursion(RandomStream& rng) const;
};

}  // namespace imunoise
