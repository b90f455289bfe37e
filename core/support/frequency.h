#pragma once

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>

namespace imunoise {

/// A frequency f, in cycles per sample, with the sine and cosine of half its angle, πf: all spectra
/// are made of them, and of these no digits cancel near 0.
struct Frequency {
  double cycles = 0.0;
  double half_sine = 0.0;
  double half_cosine = 1.0;

  Frequency(double f)  // NOLINT(google-explicit-constructor): a frequency is a number
      : cycles(f),
        half_sine(std::sin(std::numbers::pi * f)),
        half_cosine(std::cos(std::numbers::pi * f)) {}
  Frequency(double f, double sine, double cosine)
      : cycles(f), half_sine(sine), half_cosine(cosine) {}

  /// e^{-2πif}.
  std::complex<double> turn() const {
    return {1.0 - 2.0 * half_sine * half_sine, -2.0 * half_sine * half_cosine};
  }
};

/// Many of them, whose sines are worked out once: a fit asks for spectra at the same frequencies
/// thousands of times. Copies share them.
class Frequencies {
 public:
  Frequencies() = default;
  Frequencies(Eigen::ArrayXd cycles)  // NOLINT(google-explicit-constructor): see Frequency
      : Frequencies(std::move(cycles), Eigen::ArrayXd()) {}
  /// Middles of bands, and the standard deviation of the frequencies in each.
  Frequencies(Eigen::ArrayXd cycles, Eigen::ArrayXd deviation)
      : of_(std::make_shared<const Numbers>(std::move(cycles), std::move(deviation))) {}

  Eigen::Index size() const { return of_ ? of_->cycles.size() : 0; }
  /// In cycles per sample.
  double operator()(Eigen::Index i) const { return of_->cycles(i); }
  Frequency at(Eigen::Index i) const { return {of_->cycles(i), of_->sine(i), of_->cosine(i)}; }
  /// How far the frequencies of a band scatter, cycles per sample; 0 where one stands alone.
  double deviation(Eigen::Index i) const {
    return of_->deviation.size() == 0 ? 0.0 : of_->deviation(i);
  }
  /// All of them. Precondition: there are some.
  const Eigen::ArrayXd& cycles() const { return of_->cycles; }
  const Eigen::ArrayXd& half_sines() const { return of_->sine; }

 private:
  struct Numbers {
    Numbers(Eigen::ArrayXd f, Eigen::ArrayXd scatter)
        : cycles(std::move(f)),
          deviation(std::move(scatter)),
          sine((std::numbers::pi * cycles).sin()),
          cosine((std::numbers::pi * cycles).cos()) {}
    Eigen::ArrayXd cycles;
    Eigen::ArrayXd deviation;
    Eigen::ArrayXd sine;
    Eigen::ArrayXd cosine;
  };
  std::shared_ptr<const Numbers> of_;
};

}  // namespace imunoise
