#pragma once

#include <vector>

#include "core/process/ar1.h"

namespace imunoise {

/// Power-law noise of any slope α between white noise (0) and a random walk (2), as a sum of Markov
/// processes a factor of four apart in time (van der Ziel 1950): two-sided spectrum A²/(2πf)^α to
/// 0.2 % from 1e-11 to 0.1 cycles per sample; above, up to the end of the band, within the factor
/// by which sampled Markov noise differs. At α = 1 it is flicker noise, A² = B².
struct PowerLaw {
  double a2 = 1.0;     ///< A²
  double slope = 1.0;  ///< α

  static constexpr ProcessInfo kInfo{
      "PL", "power-law noise",
      "Noise whose power falls as a power of frequency: many Markov processes of many times, as "
      "in creep, relaxation and diffusion."};
  friend bool operator==(const PowerLaw&, const PowerLaw&) = default;

  std::vector<ParameterInfo> parameters() const;
  std::vector<double> values() const { return {a2, slope}; }
  void set_values(std::span<const double> v) {
    a2 = v[0];
    slope = v[1];
  }
  /// The Markov processes that it is the sum of.
  std::vector<Ar1> parts() const;
  Eigen::ArrayXd shape(HalfWidths m) const;
  Eigen::ArrayXXd shape_jacobian(HalfWidths m) const;
  double spectrum(const Frequency& f) const;
  Eigen::ArrayXd spectra(const Frequencies& f) const;
  SumCovariance sum_covariance() const;
  std::vector<DerivedQuantity> derived(Hertz) const { return {}; }
  std::vector<std::vector<double>> scan(const Scales&) const;

  class Recursion {
   public:
    double next(RandomStream& rng);

   private:
    friend PowerLaw;
    std::vector<Ar1::Recursion> parts_;
  };
  Recursion recursion(RandomStream& rng) const;
};

}  // namespace imunoise
