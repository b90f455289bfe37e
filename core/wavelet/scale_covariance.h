#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "core/wavelet/discrete_quadrature.h"
#include "core/wavelet/lag_table.h"
#include "core/wavelet/sum_covariance.h"
#include "core/wavelet/sum_covariance_terms.h"

namespace imunoise {

/// γ_jk(s) = E[W_{j,t+s} W_{k,t}] of one noise process for one pair of scales, as a function of a
/// real lag s, and how finely it must be sampled to be summed over every integer.
class ScaleCovariance {
 public:
  /// Borrows the process, and its table where there is one.
  ScaleCovariance(const SumCovariance& process, std::int64_t mj, std::int64_t mk,
                  const LagTable* table = nullptr)
      : process_(process),
        table_(table),
        mj_(static_cast<double>(mj)),
        mk_(static_cast<double>(mk)),
        linear_(process.linear),
        cubic_(process.cubic) {
    for (const ExponentialCovariance& part : process.exponentials) {
      Exponential e{};
      e.rate = -part.log_root;
      e.kernel = -part.amplitude * part.root / (part.one_minus_root * part.one_minus_root);
      e.real = e.rate.imag() == 0.0 && e.kernel.imag() == 0.0;
      e.held = table != nullptr && table->holds(exponentials_.size());
      e.split = !e.held && std::abs(e.rate) * 2.0 * (mj_ + mk_) < kSmooth;
      if (e.split) {
        linear_ += (e.kernel * sinh_minus_argument(e.rate)).real();
        cubic_ -= (e.kernel * e.rate * e.rate * e.rate / 6.0).real();
      } else {
        linear_ -= (part.amplitude * (1.0 + part.root) / (2.0 * part.one_minus_root)).real();
      }
      const Complex wj = stable_expm1(-e.rate * mj_);
      const Complex wk = stable_expm1(-e.rate * mk_);
      e.tail = e.kernel * wj * wj * wk * wk;
      exponentials_.push_back(e);
    }
  }

  double operator()(double s) const {
    const double beyond = beyond_support(s);
    double sum = without_exponentials(s, beyond);
    const bool tabulated = table_ != nullptr && s == std::floor(s);
    if (tabulated)
      for_each_lag(s, [&](double weight, double lag) { sum += weight * (*table_)(lag); });
    for (const Exponential& e : exponentials_) {
      if (!tabulated || !e.held) sum += exponential(e, s, beyond);
    }
    return sum / (4.0 * mj_ * mk_);
  }

  /// The same at whole lags from `from` on, between two kinks: powers by products.
  void at_lags(double from, std::span<double> out) const {
    const auto length = static_cast<double>(out.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double s = from + static_cast<double>(i);
      const double beyond = beyond_support(s);
      out[i] = without_exponentials(s, beyond);
      if (table_ != nullptr)
        for_each_lag(s, [&](double weight, double lag) { out[i] += weight * (*table_)(lag); });
      for (const Exponential& e : exponentials_) {
        if (e.split && !e.held) out[i] += exponential(e, s, beyond);
      }
    }
    for (const Exponential& e : exponentials_) {
      if (e.split || e.held) continue;
      const Ends ends = ends_of(e, from, from + length, from + 0.5 * length);
      const Complex step = after(e, 1.0);
      if (ends.falling != 0.0) add_powers(ends.falling, step, out.begin(), out.end());
      if (ends.rising != 0.0) add_powers(ends.rising * step, step, out.rbegin(), out.rend());
    }
    for (double& one : out) one /= 4.0 * mj_ * mk_;
  }

  using AtNodes = std::array<double, DiscreteRule::kOrder>;
  /// The same at the nodes of a rule for `points` lags from `from` on, between two kinks: there an
  /// exponential is two, one that falls and one that rises, and panels of equal length share their
  /// values at the nodes.
  AtNodes at_nodes(double from, std::int64_t points, const DiscreteRule& rule) {
    const auto length = static_cast<double>(points);
    const double middle = from + 0.5 * length;
    AtNodes out;
    for (std::size_t i = 0; i < out.size(); ++i) {
      const double s = from + rule.nodes[i];
      const double beyond = beyond_support(s);
      out[i] = without_exponentials(s, beyond);
      for (const Exponential& e : exponentials_) {
        if (e.split) out[i] += exponential(e, s, beyond);
      }
    }
    for (Exponential& e : exponentials_) {
      if (e.split) continue;
      const auto [falling, rising] = ends_of(e, from, from + length, middle);
      if (falling == 0.0 && rising == 0.0) continue;
      if (e.points != points) remember_nodes(e, points, rule);
      for (std::size_t i = 0; i < out.size(); ++i)
        out[i] += (falling * e.falling[i] + rising * e.rising[i]).real();
    }
    for (double& one : out) one /= 4.0 * mj_ * mk_;
    return out;
  }

  // Lags next to a kink of γ that must be summed one by one.
  std::int64_t direct_reach() const {
    double reach = std::max(12.0, static_cast<double>(process_.near.size()));
    for (const Exponential& e : exponentials_) {
      if (longest_panel(e) < kLeastPanel) reach = std::max(reach, kForgotten / e.rate.real());
    }
    return static_cast<std::int64_t>(std::min(reach, 1e9));
  }

  // Longest quadrature panel that follows the oscillations at a distance from the nearest kink.
  double panel_limit(double distance) const {
    double limit = 1e300;
    for (const Exponential& e : exponentials_) {
      if (distance * e.rate.real() < kForgotten) limit = std::min(limit, longest_panel(e));
    }
    return std::max(limit, kLeastPanel);
  }

  // Lags beyond the support after which γ is negligible.
  double tail_reach() const {
    auto reach = static_cast<double>(process_.near.size());
    for (const Exponential& e : exponentials_) reach = std::max(reach, kForgotten / e.rate.real());
    if (process_.flicker > 0.0) reach = std::max(reach, 256.0 * (mj_ + mk_));
    return reach;
  }

 private:
  using Complex = std::complex<double>;
  static constexpr std::array<double, 3> kDifference = {1.0, -2.0,
                                                        1.0};  // p of the Haar wavelet on sums
  static constexpr auto kLeastPanel = static_cast<double>(DiscreteRule::kLeastPoints);
  static constexpr double kForgotten =
      27.0;  // e^-27: an exponential counts as zero after this many lengths
  static constexpr double kNothing = 45.0;  // e^-45: below the rounding of anything it is added to
  static constexpr double kSmooth = 16.0;   // |log root|·lag below which polynomials are split off

  struct Exponential {
    Complex rate;    // L = -log root
    Complex kernel;  // factor of e^{-L|s|} in Γ
    Complex tail;    // the same after both wavelets, beyond the support
    bool real;
    bool split;  // polynomials split off, see sum_covariance_terms.h
    bool held;   // in the table
    // e^-Lx at the nodes of a panel of so many points, x from its begin and to its end.
    std::int64_t points = 0;
    std::array<Complex, DiscreteRule::kOrder> falling{};
    std::array<Complex, DiscreteRule::kOrder> rising{};
  };

  // Distance outside the support, where positive.
  double beyond_support(double s) const { return std::max(s - 2.0 * mj_, -s - 2.0 * mk_); }

  double without_exponentials(double s, double beyond) const {
    double sum = 0.0;
    if (beyond <= 0.0) {
      for_each_lag(s, [&](double weight, double lag) {
        sum += weight * lag * (linear_ + cubic_ * lag * lag);
      });
    }
    if (!process_.near.empty() && beyond < static_cast<double>(process_.near.size())) {
      for_each_lag(s, [&](double weight, double lag) {
        const auto at = static_cast<std::size_t>(lag);
        if (at < process_.near.size()) sum += weight * process_.near[at];
      });
    }
    if (process_.flicker > 0.0) sum += process_.flicker * flicker(s, beyond);
    return sum;
  }

  static Complex after(const Exponential& e, double lag) {
    if (e.real) return std::exp(-e.rate.real() * lag);
    return std::exp(-e.rate * lag);
  }

  // What falls from the begin of a panel on, at that, and what rises to its end.
  struct Ends {
    Complex falling = 0.0;
    Complex rising = 0.0;
  };
  Ends ends_of(const Exponential& e, double begin, double end, double middle) const {
    Ends out;
    const auto add = [&](Complex factor, double at_begin, double at_end) {
      const bool falls = at_begin < at_end;
      const double distance = falls ? at_begin : at_end;
      if (e.rate.real() * distance < kNothing)
        (falls ? out.falling : out.rising) += factor * after(e, distance);
    };
    if (beyond_support(middle) > 0.0) {
      add(e.tail, beyond_support(begin), beyond_support(end));
      return out;
    }
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) {
        const double kink = static_cast<double>(a) * mj_ - static_cast<double>(b) * mk_;
        add(kDifference[a] * kDifference[b] * e.kernel, std::abs(begin - kink),
            std::abs(end - kink));
      }
    }
    return out;
  }

  // Adds Re(first·step^i) to number i. Four chains of products, which the processor works on at
  // once.
  template <class Iterator>
  static void add_powers(Complex first, Complex step, Iterator at, Iterator end) {
    constexpr std::size_t kChains = 4;
    const Complex jump = step * step * step * step;
    std::array<double, kChains> real{};
    std::array<double, kChains> imag{};
    for (std::size_t c = 0; c < kChains; ++c) {
      real[c] = first.real();
      imag[c] = first.imag();
      first *= step;
    }
    for (std::size_t c = 0; at != end; ++at, c = (c + 1) % kChains) {
      *at += real[c];
      const double next = real[c] * jump.real() - imag[c] * jump.imag();
      imag[c] = real[c] * jump.imag() + imag[c] * jump.real();
      real[c] = next;
    }
  }

  static void remember_nodes(Exponential& e, std::int64_t points, const DiscreteRule& rule) {
    e.points = points;
    for (std::size_t i = 0; i < e.falling.size(); ++i) {
      e.falling[i] = after(e, rule.nodes[i]);
      e.rising[i] = after(e, static_cast<double>(points) - rule.nodes[i]);
    }
  }

  template <class Visit>
  void for_each_lag(double s, const Visit& visit) const {
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) {
        const double lag = s - static_cast<double>(a) * mj_ + static_cast<double>(b) * mk_;
        visit(kDifference[a] * kDifference[b], std::abs(lag));
      }
    }
  }

  static double longest_panel(const Exponential& e) {
    const double turn = std::abs(e.rate.imag());
    return turn > 0.0 ? 6.0 / turn : 1e300;
  }

  double exponential(const Exponential& e, double s, double beyond) const {
    if (beyond > 0.0) {
      if (!(e.rate.real() * beyond < kNothing)) return 0.0;
      if (e.real) return e.tail.real() * std::exp(-e.rate.real() * beyond);
      return (e.tail * std::exp(-e.rate * beyond)).real();
    }
    double sum = 0.0;
    if (e.real) {
      const double rate = e.rate.real();
      for_each_lag(s, [&](double weight, double lag) {
        const double x = rate * lag;
        if (e.split) {
          sum += weight * exponential_remainder(x);
        } else if (x < kNothing) {
          sum += weight * std::exp(-x);
        }
      });
      return sum * e.kernel.real();
    }
    for_each_lag(s, [&](double weight, double lag) {
      if (e.split) {
        sum += weight * (e.kernel * exponential_remainder(e.rate * lag)).real();
      } else if (e.rate.real() * lag < kNothing) {
        sum += weight * (e.kernel * std::exp(-e.rate * lag)).real();
      }
    });
    return sum;
  }

  double flicker(double s, double beyond) const {
    double sum = 0.0;
    if (beyond > 4.0 * (mj_ + mk_)) {  // Φ'''' = -1/(π s²), where differences would cancel
      const double centre = s - mj_ + mk_;
      return -mj_ * mj_ * mk_ * mk_ / (std::numbers::pi * centre * centre);
    }
    for_each_lag(s,
                 [&](double weight, double lag) { sum += weight * flicker_sum_covariance(lag); });
    return sum;
  }

  const SumCovariance& process_;
  const LagTable* table_;
  double mj_;
  double mk_;
  double linear_;
  double cubic_;
  std::vector<Exponential> exponentials_;
};

}  // namespace imunoise
