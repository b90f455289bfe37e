#include "core/process/low_pass.h"

#include <algorithm>

#include "core/process/exponential_shape.h"
#include "core/support/linear_algebra.h"

namespace imunoise {
namespace {

using Complex = std::complex<double>;
constexpr Complex kI(0.0, 1.0);

// A pole of 1/(1 + s^2n) in the upper half plane; those that are mirrored at the imaginary axis
// count twice.
struct Pole {
  Complex at;
  double times;
};

std::vector<Pole> poles(int order) {
  std::vector<Pole> out;
  for (int k = 1; 2 * k <= order + 1; ++k) {
    const bool alone = 2 * k == order + 1;
    const double angle = std::numbers::pi * (2 * k - 1) / (2.0 * order);
    out.push_back({alone ? kI : std::polar(1.0, angle), alone ? 1.0 : 2.0});
  }
  return out;
}

double power(double base, int exponent) {
  double out = 1.0;
  for (; exponent > 0; exponent /= 2, base *= base) {
    if (exponent % 2 == 1) out *= base;
  }
  return out;
}

// tan(Ω/2), kept away from 1: there a filter of odd order has a root at 0, and its autocovariance
// no longer splits into parts.
double prewarped(double omega) {
  constexpr double kEnd = 1e-5;
  const double out = std::tan(0.5 * omega);
  return std::abs(out - 1.0) < kEnd ? 1.0 + kEnd : out;
}

// Modes y_k with complex roots, x = Σ times · Re(weight · y), and one that has forgotten all
// before, as real states.
class Modes {
 public:
  explicit Modes(const std::vector<Pole>& all) {
    for (const Pole& one : all) {
      first_.push_back(states_);
      states_ += one.times > 1.0 ? 2 : 1;
    }
  }
  Eigen::Index states() const { return states_; }

  // Real and imaginary part of a mode's number along the states.
  template <class Put>
  void place(std::size_t mode, Put put) const {
    put(first_[mode], true);
    const Eigen::Index end = mode + 1 < first_.size() ? first_[mode + 1] : states_;
    if (end - first_[mode] == 2) put(first_[mode] + 1, false);
  }

  Eigen::MatrixXd transition(const std::vector<Complex>& roots) const {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(states_, states_);
    for (std::size_t k = 0; k < roots.size(); ++k) {
      place(k, [&](Eigen::Index row, bool real_row) {
        place(k, [&](Eigen::Index column, bool real_column) {
          const double turned = real_row ? -roots[k].imag() : roots[k].imag();
          out(row, column) = real_row == real_column ? roots[k].real() : turned;
        });
      });
    }
    return out;
  }

  Eigen::RowVectorXd output(const std::vector<Pole>& all,
                            const std::vector<Complex>& weights) const {
    Eigen::RowVectorXd out(states_);
    for (std::size_t k = 0; k < all.size(); ++k) {
      const Complex w = all[k].times * weights[k];
      place(k, [&](Eigen::Index at, bool real) { out(at) = real ? w.real() : -w.imag(); });
    }
    return out;
  }

  // From E[a_j a_k] and E[a_j conj(a_k)] of complex numbers.
  template <class Product>
  Eigen::MatrixXd covariance(Product product, const std::vector<Complex>& roots) const {
    Eigen::MatrixXd out(states_, states_);
    for (std::size_t j = 0; j < roots.size(); ++j) {
      for (std::size_t k = 0; k < roots.size(); ++k) {
        const Complex plain = product(roots[j], roots[k]);
        const Complex crossed = product(roots[j], std::conj(roots[k]));
        place(j, [&](Eigen::Index row, bool real_row) {
          place(k, [&](Eigen::Index column, bool real_column) {
            out(row, column) = 0.5 * (real_row && real_column ? (plain + crossed).real()
                                      : real_row              ? (plain - crossed).imag()
                                      : real_column           ? (plain + crossed).imag()
                                                              : (crossed - plain).real());
          });
        });
      }
    }
    return out;
  }

 private:
  std::vector<Eigen::Index> first_;
  Eigen::Index states_ = 0;
};

// All poles, the mirrored ones too.
std::vector<Complex> with_mirrored(const std::vector<Complex>& roots) {
  std::vector<Complex> out;
  for (const Complex& one : roots) {
    out.push_back(one);
    if (one.imag() != 0.0) out.push_back(std::conj(one));
  }
  return out;
}

}  // namespace

Eigen::ArrayXd LowPassCovariance::variance(HalfWidths m) const {
  return m.unaryExpr([&](double width) {
    double sum = 0.5 * white / width;
    for (const Part& one : parts)
      sum += (one.amplitude * exponential_shape(one.rate, width).value).real();
    return sum;
  });
}

Eigen::ArrayXd LowPassCovariance::slope(HalfWidths m) const {
  return m.unaryExpr([&](double width) {
    double sum = 0.5 * white_slope / width;
    for (const Part& one : parts) {
      const auto k = exponential_shape(one.rate, width);
      sum += (k.value * (one.amplitude_slope + one.amplitude * k.log_derivative * one.rate_slope))
                 .real();
    }
    return sum;
  });
}

SumCovariance LowPassCovariance::sum_covariance() const {
  SumCovariance out{.linear = -0.5 * white};
  for (const Part& one : parts) {
    out.exponentials.push_back({one.amplitude, std::exp(-one.rate), -one.rate, one.one_minus_root});
  }
  return out;
}

// The sum over what folds back. Three turns to each side exactly; the rest, far above the cut-off,
// is Ω^2n Σ (2πj ± w)^-2n by the Euler-Maclaurin formula. Error below 1e-7.
double AnalogLowPass::gain(int order, double omega, const Frequency& f) {
  constexpr int kExact = 3;
  const double turn = 2.0 * std::numbers::pi / omega;
  const double p = 2.0 * order;
  double sum = 0.0;
  for (int j = -kExact; j <= kExact; ++j)
    sum += 1.0 / (1.0 + power((f.cycles + j) * turn, 2 * order));
  for (const double side : {1.0, -1.0}) {
    const double first = kExact + 1 + side * f.cycles;
    const double inverse = 1.0 / first;
    const double factor =
        first / (p - 1.0) + 0.5 +
        p * inverse / 12.0 * (1.0 - (p + 1.0) * (p + 2.0) * inverse * inverse / 60.0);
    sum += factor * power(inverse / turn, 2 * order);
  }
  return sum;
}

// Residues of 1/(1 + (w/Ω)^2n) · exp(iwh) at w = Ωs: -s/2n.
LowPassCovariance AnalogLowPass::covariance(int order, double omega) {
  LowPassCovariance out;
  for (const Pole& pole : poles(order)) {
    const Complex amplitude_slope = pole.times / (2.0 * order) * (-kI * pole.at);
    const Complex rate_slope = -kI * pole.at;
    const Complex rate = omega * rate_slope;
    out.parts.push_back(
        {omega * amplitude_slope, rate, amplitude_slope, rate_slope, -stable_expm1(-rate)});
  }
  return out;
}

// y' = p y + white noise, for each pole p of H(s) = Π 1/(1 - s/p); x is the sum of the residues
// times y.
LinearSystem AnalogLowPass::system(int order, double omega) {
  const std::vector<Pole> all = poles(order);
  std::vector<Complex> rates;
  std::vector<Complex> roots;
  for (const Pole& one : all) {
    rates.push_back(kI * omega * one.at);
    if (one.times == 1.0) rates.back() = -omega;
    roots.push_back(std::exp(rates.back()));
  }
  std::vector<Complex> weights;
  for (const Complex& p : rates) {
    Complex weight = -p;
    for (const Complex& other : with_mirrored(rates)) {
      if (other != p) weight *= other / (other - p);
    }
    weights.push_back(weight);
  }
  const Modes modes(all);
  LinearSystem out;
  out.transition = modes.transition(roots);
  out.input = square_root(
      modes.covariance([](Complex a, Complex b) { return stable_expm1(a + b) / (a + b); }, rates));
  out.output = modes.output(all, weights);
  out.stationary = modes.covariance([](Complex a, Complex b) { return -1.0 / (a + b); }, rates);
  return out;
}

double DigitalLowPass::gain(int order, double omega, const Frequency& f) {
  const double top = power(f.half_cosine * std::tan(0.5 * omega), 2 * order);
  return top / (top + power(f.half_sine, 2 * order));
}

// With t = tan(θ/2): residues of 1/(1 + (t/T)^2n) · z^h / (1 + t²), z = (1 + it)/(1 - it), at t =
// Ts, and at t = i for h = 0.
LowPassCovariance DigitalLowPass::covariance(int order, double omega) {
  const double warped = prewarped(omega);
  const double slope = 0.5 * (1.0 + warped * warped);  // of T, by Ω
  const double sign = order % 2 == 0 ? 1.0 : -1.0;
  const double tall = power(warped, 2 * order);
  const double bottom = tall + sign;
  LowPassCovariance out;
  out.white = tall / bottom;
  out.white_slope = slope * sign * 2.0 * order * tall / warped / (bottom * bottom);
  for (const Pole& pole : poles(order)) {
    const Complex t = warped * pole.at;
    const Complex square = 1.0 + t * t;
    const Complex by_t = slope * pole.at;
    const double times = pole.times / order;
    out.parts.push_back({times * (-kI * t) / square, -2.0 * kI * std::atan(t),
                         times * (-kI * (1.0 - t * t)) / (square * square) * by_t,
                         -2.0 * kI / square * by_t, -2.0 * kI * t / (1.0 - kI * t)});
  }
  return out;
}

// H = d + Σ weight/(1 - z/turn): modes that share one source, and the source itself.
LinearSystem DigitalLowPass::system(int order, double omega) {
  const std::vector<Pole> all = poles(order);
  const double warped = prewarped(omega);
  std::vector<Complex> analog;
  std::vector<Complex> roots;
  for (const Pole& one : all) {
    analog.push_back(one.times == 1.0 ? Complex(-warped) : kI * warped * one.at);
    roots.push_back((1.0 + analog.back()) / (1.0 - analog.back()));
  }
  // Π s/(s - 1) · (1 + w)/(1 - zw) over all poles s, with w one sample back.
  Complex scale = 1.0;
  for (const Complex& s : with_mirrored(analog)) scale *= s / (s - 1.0);
  const std::vector<Complex> every = with_mirrored(roots);
  Complex direct = scale;
  for (const Complex& z : every) direct *= -1.0 / z;
  std::vector<Complex> weights;
  for (const Complex& z : roots) {
    Complex weight = scale;
    for (const Complex& other : every) {
      weight *= 1.0 + 1.0 / z;
      if (other != z) weight /= 1.0 - other / z;
    }
    weights.push_back(weight);
  }
  const Modes modes(all);
  const Eigen::Index n = modes.states() + 1;
  LinearSystem out;
  out.transition = Eigen::MatrixXd::Zero(n, n);
  out.transition.topLeftCorner(n - 1, n - 1) = modes.transition(roots);
  out.input = Eigen::MatrixXd::Zero(n, 1);
  for (std::size_t k = 0; k < roots.size(); ++k)
    modes.place(k, [&](Eigen::Index at, bool real) { out.input(at, 0) = real ? 1.0 : 0.0; });
  out.input(n - 1, 0) = 1.0;
  out.output.resize(n);
  out.output << modes.output(all, weights), direct.real();
  // What the source adds to every mode is in it once.
  out.stationary = out.input * out.input.transpose();
  out.stationary.topLeftCorner(n - 1, n - 1) =
      modes.covariance([](Complex a, Complex b) { return 1.0 / (1.0 - a * b); }, roots);
  return out;
}

}  // namespace imunoise
