#include "core/effect/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>

#include "core/spectrum/cosine_transform.h"
#include "core/spectrum/roots_of_unity.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

Eigen::ArrayXd times(Index n) {
  return Eigen::ArrayXd::LinSpaced(n, 0.0, static_cast<double>(n - 1));
}

double scale_of(Index n) { return std::sqrt(2.0 / static_cast<double>(n)); }

// Calls `one` with k, the cosine and the sine of half the angle θ_k = πk/n of coefficient k = 1 …
// n-1; on several threads. What is small has all its digits.
template <class One>
void for_each_coefficient(Index n, const One& one) {
  constexpr Index kPiece = 1 << 16;
  const RootsOfUnity roots(4 * static_cast<std::size_t>(n));
  for_each_index(static_cast<std::size_t>((n + kPiece - 1) / kPiece), [&](std::size_t piece) {
    const Index begin = static_cast<Index>(piece) * kPiece;
    for (Index k = std::max<Index>(begin, 1); k < std::min(n, begin + kPiece); ++k) {
      const bool low = 2 * k <= n;
      const std::complex<double> root = roots(static_cast<std::size_t>(low ? k : n - k));
      one(k, low ? root.real() : root.imag(), low ? root.imag() : root.real());
    }
  });
}

Eigen::VectorXd ramp_cosines(Index n, double rate) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(n - 1);
  const double scale = scale_of(n) / rate;
  for_each_coefficient(n, [&](Index k, double cosine, double sine) {
    if (k % 2 == 1) out(k - 1) = -0.5 * scale * cosine / (sine * sine);
  });
  return out;
}

Eigen::VectorXd warm_up_cosines(Index n, double tau) {
  Eigen::VectorXd out(n - 1);
  const double falls = -std::expm1(-1.0 / tau);  // 1 - q
  const double q = 1.0 - falls;
  const double end = std::exp(-static_cast<double>(n) / tau);
  const double scale = scale_of(n) * falls;
  for_each_coefficient(n, [&](Index k, double cosine, double sine) {
    const double last = k % 2 == 0 ? 1.0 - end : 1.0 + end;
    out(k - 1) = scale * last * cosine / (falls * falls + 4.0 * q * sine * sine);
  });
  return out;
}

Eigen::VectorXd step_cosines(Index n, Index at) {
  Eigen::VectorXd out(n - 1);
  const double scale = scale_of(n);
  const auto turn = 2 * static_cast<std::uint64_t>(n);
  const RootsOfUnity roots(turn);
  for_each_coefficient(n, [&](Index k, double, double sine) {
    const std::uint64_t place = static_cast<std::uint64_t>(at) * static_cast<std::uint64_t>(k);
    out(k - 1) = -0.5 * scale * roots(place % turn).imag() / sine;
  });
  return out;
}

// sin(na/2)/sin(a/2): the sum of e^{iat} over n samples, but for its phase.
double summed(double n, double a) {
  const double below = std::sin(0.5 * a);
  return below == 0.0 ? n : std::sin(0.5 * n * a) / below;
}

// The transform of cos(ωt + φ) for the phases 0 and -π/2. With ψ = φ + (n-1)ω/2 the coefficient is
// √(2/n) N 2 sin(ω/2) cos(θ/2)/(cos θ - cos ω), where N is sin(nω/2) cos ψ for even k and
// -cos(nω/2) sin ψ for odd k. Next to ω both fractions of that lose their digits: there each of the
// two waves that a product of cosines makes is summed by itself.
void wave_cosines(Index n, double omega, Eigen::Ref<Eigen::MatrixXd> out) {
  const auto length = static_cast<double>(n);
  const double scale = scale_of(n);
  const double half_sine = std::sin(0.5 * omega);
  const double half_cosine = std::cos(0.5 * omega);
  const std::array<double, 2> phases{0.0, -0.5 * std::numbers::pi};
  std::array<double, 2> even{};
  std::array<double, 2> odd{};
  for (std::size_t p = 0; p < 2; ++p) {
    const double psi = phases[p] + 0.5 * (length - 1.0) * omega;
    even[p] = scale * half_sine * std::sin(0.5 * length * omega) * std::cos(psi);
    odd[p] = -scale * half_sine * std::cos(0.5 * length * omega) * std::sin(psi);
  }
  const double near = 4.0 * std::numbers::pi / length;
  for_each_coefficient(n, [&](Index k, double cosine, double sine) {
    const double theta = std::numbers::pi * static_cast<double>(k) / length;
    if (std::abs(theta - omega) < near) {
      for (std::size_t p = 0; p < 2; ++p) {
        const auto wave = [&](double angle) {
          return summed(length, omega + angle) *
                 std::cos(phases[p] + 0.5 * angle + 0.5 * (length - 1.0) * (omega + angle));
        };
        out(k - 1, static_cast<Index>(p)) = 0.5 * scale * (wave(theta) + wave(-theta));
      }
      return;
    }
    // (cos θ - cos ω)/2 from whichever half angles are small, which keeps its digits.
    const double apart = half_sine < half_cosine ? (half_sine - sine) * (half_sine + sine)
                                                 : (cosine - half_cosine) * (cosine + half_cosine);
    const std::array<double, 2>& part = k % 2 == 0 ? even : odd;
    out(k - 1, 0) = part[0] * cosine / apart;
    out(k - 1, 1) = part[1] * cosine / apart;
  });
}

// Adds a cos ωt + b sin ωt: each stretch is the first one, turned.
void add_wave(double omega, double a, double b, Eigen::VectorXd& to) {
  constexpr Index kStretch = 512;
  const Eigen::ArrayXd angle = omega * times(std::min(kStretch, to.size()));
  const Eigen::ArrayXd cosine = angle.cos();
  const Eigen::ArrayXd sine = angle.sin();
  for (Index begin = 0; begin < to.size(); begin += kStretch) {
    const Index size = std::min(kStretch, to.size() - begin);
    const double c = std::cos(omega * static_cast<double>(begin));
    const double s = std::sin(omega * static_cast<double>(begin));
    to.segment(begin, size).array() +=
        (a * c + b * s) * cosine.head(size) + (b * c - a * s) * sine.head(size);
  }
}

}  // namespace

Shape ramp(double rate) {
  return {[=](const Eigen::VectorXd& slope, Eigen::VectorXd& to) {
            to.array() += slope(0) / rate * times(to.size());
          },
          [=](Index n) -> Eigen::MatrixXd { return ramp_cosines(n, rate); }};
}

Shape warm_up(double tau, Index after) {
  const double left = std::exp(-static_cast<double>(after) / tau);
  return {[=](const Eigen::VectorXd& amplitude, Eigen::VectorXd& to) {
            to.array() += amplitude(0) * left * (-times(to.size()) / tau).exp();
          },
          [=](Index n) -> Eigen::MatrixXd { return left * warm_up_cosines(n, tau); }};
}

Shape step(Index at) {
  return {[=](const Eigen::VectorXd& height, Eigen::VectorXd& to) {
            if (at < to.size()) to.tail(to.size() - at).array() += height(0);
          },
          [=](Index n) -> Eigen::MatrixXd { return step_cosines(n, std::min(at, n)); }};
}

Shape waves(double frequency, int harmonics) {
  const auto omega = [=](int h) { return 2.0 * std::numbers::pi * (h + 1) * frequency; };
  return {[=](const Eigen::VectorXd& coefficients, Eigen::VectorXd& to) {
            for (int h = 0; h < harmonics; ++h) {
              const double a = coefficients(2 * h);
              const double b = coefficients(2 * h + 1);
              if (a != 0.0 || b != 0.0) add_wave(omega(h), a, b, to);
            }
          },
          [=](Index n) {
            Eigen::MatrixXd out(n - 1, 2 * harmonics);
            for (int h = 0; h < harmonics; ++h) wave_cosines(n, omega(h), out.middleCols(2 * h, 2));
            return out;
          }};
}

Shape half_waves(Index length, int count, Index after) {
  const auto omega = [=](Index k) {
    return std::numbers::pi * static_cast<double>(k + 1) / static_cast<double>(length);
  };
  // cos(ωt + φ) = cos φ cos ωt - sin φ sin ωt
  const auto turned = [=](Index k) -> Eigen::Vector2d {
    const double phase = omega(k) * (static_cast<double>(after) + 0.5);
    return {std::cos(phase), -std::sin(phase)};
  };
  const auto at_end = [](Index k) { return k % 2 == 0 ? -1.0 : 1.0; };
  const auto moving = [=](Index n) { return std::clamp<Index>(length - after, 0, n); };
  return {[=](const Eigen::VectorXd& coefficients, Eigen::VectorXd& to) {
            const Index n = moving(to.size());
            Eigen::VectorXd head = to.head(n);
            for (Index k = 0; k < count; ++k) {
              const Eigen::Vector2d parts = coefficients(k) * turned(k);
              add_wave(omega(k), parts.x(), parts.y(), head);
              to.tail(to.size() - n).array() += coefficients(k) * at_end(k);
            }
            to.head(n) = head;
          },
          [=](Index n) {
            Eigen::MatrixXd out(n - 1, count);
            if (moving(n) < n) {
              for (Index k = 0; k < count; ++k) {
                Eigen::VectorXd column = Eigen::VectorXd::Constant(n, at_end(k));
                for (Index t = 0; t < moving(n); ++t)
                  column(t) = std::cos(omega(k) * (static_cast<double>(t + after) + 0.5));
                out.col(k) = cosine_transform(column);
              }
              return out;
            }
            Eigen::MatrixXd pair(n - 1, 2);
            for (Index k = 0; k < count; ++k) {
              wave_cosines(n, omega(k), pair);
              out.col(k) = pair * turned(k);
            }
            return out;
          }};
}

}  // namespace imunoise
