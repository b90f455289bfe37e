#include "core/wavelet/moment_covariance.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "core/support/parallel.h"
#include "core/wavelet/discrete_quadrature.h"
#include "core/wavelet/sum_covariance_terms.h"

namespace imunoise {
namespace {

using Complex = std::complex<double>;

constexpr std::array<double, 3> kDifference = {1.0, -2.0, 1.0};  // p of the Haar wavelet on sums
constexpr auto kLeastPanel = static_cast<double>(DiscreteRule::kLeastPoints);
constexpr double kForgotten = 27.0;  // e^-27: an exponential counts as zero after this many lengths
constexpr double kNothing = 45.0;    // e^-45: below the rounding of anything it is added to
constexpr double kSmooth = 16.0;     // |log root|·lag below which polynomials are split off

// γ_jk(s) = E[W_{j,t+s} W_{k,t}] for one pair of scales.
class CrossCovariance {
 public:
  CrossCovariance(const SumCovariance& process, std::int64_t mj, std::int64_t mk)
      : process_(process),
        mj_(static_cast<double>(mj)),
        mk_(static_cast<double>(mk)),
        linear_(process.linear),
        cubic_(process.cubic) {
    for (const ExponentialCovariance& part : process.exponentials) {
      Exponential e{};
      e.rate = -part.log_root;
      e.kernel = -part.amplitude * part.root / (part.one_minus_root * part.one_minus_root);
      e.real = e.rate.imag() == 0.0 && e.kernel.imag() == 0.0;
      e.split = std::abs(e.rate) * 2.0 * (mj_ + mk_) < kSmooth;
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
    const double beyond = std::max(s - 2.0 * mj_, -s - 2.0 * mk_);  // distance outside the support
    double sum = 0.0;
    if (beyond <= 0.0) {
      for_each_lag(s, [&](double weight, double lag) {
        sum += weight * lag * (linear_ + cubic_ * lag * lag);
      });
    }
    if (beyond < static_cast<double>(process_.near.size())) {
      for_each_lag(s, [&](double weight, double lag) {
        const auto at = static_cast<std::size_t>(lag);
        if (at < process_.near.size()) sum += weight * process_.near[at];
      });
    }
    for (const Exponential& e : exponentials_) sum += exponential(e, s, beyond);
    if (process_.flicker > 0.0) sum += process_.flicker * flicker(s, beyond);
    return sum / (4.0 * mj_ * mk_);
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
  struct Exponential {
    Complex rate;    // L = -log root
    Complex kernel;  // factor of e^{-L|s|} in Γ
    Complex tail;    // the same after both wavelets, beyond the support
    bool real;
    bool split;  // polynomials split off, see sum_covariance_terms.h
  };

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
      const Complex value = e.split ? exponential_remainder(e.rate * lag) : std::exp(-e.rate * lag);
      sum += weight * (e.kernel * value).real();
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
  double mj_;
  double mk_;
  double linear_;
  double cubic_;
  std::vector<Exponential> exponentials_;
};

// Σ_s over [begin, end) of c(s)γ(s)² and c(s)γ(s), where γ is smooth inside and may have kinks at
// the ends.
class LagSums {
 public:
  LagSums(std::int64_t samples, std::int64_t mj, std::int64_t mk, const CrossCovariance& gamma,
          std::map<std::int64_t, DiscreteRule>& rules)
      : samples_(static_cast<double>(samples)),
        mj_(static_cast<double>(mj)),
        mk_(static_cast<double>(mk)),
        gamma_(gamma),
        rules_(rules),
        reach_(gamma.direct_reach()) {}

  void add_interval(std::int64_t begin, std::int64_t end) {
    const std::int64_t middle = begin + (end - begin) / 2;
    add_half(begin, middle, begin, +1);
    add_half(middle, end, end, -1);
  }

  double squares = 0.0;
  double plain = 0.0;

 private:
  // Panels that grow with the distance from the kink, which lies at one end of [begin, end).
  void add_half(std::int64_t begin, std::int64_t end, std::int64_t kink, int direction) {
    std::int64_t done = 0;  // points summed, counted from the kink
    const std::int64_t total = end - begin;
    while (done < total) {
      const auto distance = static_cast<double>(done);
      std::int64_t length =
          done < reach_
              ? reach_ - done
              : static_cast<std::int64_t>(std::min(3.0 * distance, gamma_.panel_limit(distance)));
      if (total - done - length < DiscreteRule::kLeastPoints) length = total - done;
      const std::int64_t from = direction > 0 ? kink + done : kink - done - length;
      if (done < reach_ || length < DiscreteRule::kLeastPoints) {
        for (std::int64_t s = from; s < from + length; ++s) add(static_cast<double>(s), 1.0);
      } else {
        auto found = rules_.find(length);
        if (found == rules_.end()) found = rules_.emplace(length, discrete_rule(length)).first;
        for (std::size_t i = 0; i < DiscreteRule::kOrder; ++i) {
          add(static_cast<double>(from) + found->second.nodes[i], found->second.weights[i]);
        }
      }
      done += length;
    }
  }

  void add(double s, double weight) {
    const double pairs =
        std::min(samples_, samples_ - s) - std::max(2.0 * mk_, 2.0 * mj_ - s) + 1.0;
    const double value = gamma_(s);
    squares += weight * pairs * value * value;
    plain += weight * pairs * value;
  }

  double samples_;
  double mj_;
  double mk_;
  const CrossCovariance& gamma_;
  std::map<std::int64_t, DiscreteRule>& rules_;
  std::int64_t reach_;
};

double entry(const SumCovariance& process, std::int64_t mj, std::int64_t mk, std::int64_t samples,
             std::map<std::int64_t, DiscreteRule>& rules) {
  const CrossCovariance gamma(process, mj, mk);
  const auto tail =
      static_cast<std::int64_t>(std::min(gamma.tail_reach(), static_cast<double>(samples)));
  const std::int64_t first = std::max(2 * mj - samples, -2 * mk - tail);
  const std::int64_t last = std::min(samples - 2 * mk, 2 * mj + tail);
  std::vector<std::int64_t> kinks = {first, last + 1};
  for (std::int64_t a = 0; a < 3; ++a) {
    for (std::int64_t b = 0; b < 3; ++b) {
      const std::int64_t s = a * mj - b * mk;
      if (first < s && s <= last) kinks.push_back(s);
      // Tails follow another formula than the support: no panel may straddle its ends.
      if (s == 2 * mj && s + 1 <= last) kinks.push_back(s + 1);
    }
  }
  std::sort(kinks.begin(), kinks.end());
  kinks.erase(std::unique(kinks.begin(), kinks.end()), kinks.end());

  LagSums sums(samples, mj, mk, gamma, rules);
  for (std::size_t i = 0; i + 1 < kinks.size(); ++i) sums.add_interval(kinks[i], kinks[i + 1]);

  const auto count = [&](std::int64_t m) { return static_cast<double>(samples - 2 * m + 1); };
  const double mean_j_mean_k =
      process.slope_squared * static_cast<double>(mj) * static_cast<double>(mk) / 4.0;
  return (2.0 * sums.squares + 4.0 * mean_j_mean_k * sums.plain) / (count(mj) * count(mk));
}

}  // namespace

Eigen::MatrixXd moment_covariance(const SumCovariance& process, const Scales& scales,
                                  std::size_t samples) {
  const auto n = static_cast<Eigen::Index>(scales.size());
  assert(n == 0 || static_cast<std::size_t>(2 * scales.largest()) <= samples);
  Eigen::MatrixXd out(n, n);
  // Rows are unequal in cost: hand out the longest first.
  for_each_index(scales.size(), [&](std::size_t row) {
    const std::size_t j = scales.size() - 1 - row;
    std::map<std::int64_t, DiscreteRule> rules;
    for (std::size_t k = 0; k <= j; ++k) {
      const double value =
          entry(process, scales[j], scales[k], static_cast<std::int64_t>(samples), rules);
      out(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(k)) = value;
      out(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(j)) = value;
    }
  });
  return out;
}

}  // namespace imunoise
