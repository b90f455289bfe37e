#include "core/wavelet/lag_sums.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/support/parallel.h"
#include "core/wavelet/discrete_quadrature.h"
#include "core/wavelet/scale_covariance.h"

namespace imunoise {
namespace {

// Σ_s over [begin, end) of c(s)γ^p(s)γ^q(s) and c(s)γ^p(s), where γ is smooth inside and may have
// kinks at the ends.
class Summation {
 public:
  Summation(std::int64_t samples, std::int64_t mj, std::int64_t mk,
            std::vector<ScaleCovariance>& gammas)
      : samples_(static_cast<double>(samples)),
        mj_(static_cast<double>(mj)),
        mk_(static_cast<double>(mk)),
        gammas_(gammas),
        values_(static_cast<Eigen::Index>(gammas.size())) {
    const auto size = static_cast<Eigen::Index>(gammas.size());
    products = Eigen::MatrixXd::Zero(size, size);
    plain = Eigen::VectorXd::Zero(size);
    for (const ScaleCovariance& gamma : gammas) reach_ = std::max(reach_, gamma.direct_reach());
  }

  void add_interval(std::int64_t begin, std::int64_t end) {
    const std::int64_t middle = begin + (end - begin) / 2;
    add_half(begin, middle, begin, +1);
    add_half(middle, end, end, -1);
  }

  Eigen::MatrixXd products;  // lower triangle
  Eigen::VectorXd plain;

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
              : static_cast<std::int64_t>(std::min(3.0 * distance, panel_limit(distance)));
      if (total - done - length < DiscreteRule::kLeastPoints) length = total - done;
      const std::int64_t from = direction > 0 ? kink + done : kink - done - length;
      if (done < reach_ || length < DiscreteRule::kLeastPoints) {
        add_lags(from, length);
      } else {
        add_panel(static_cast<double>(from), length);
      }
      done += length;
    }
  }

  void add_lags(std::int64_t from, std::int64_t count) {
    constexpr std::int64_t kAtOnce = 256;  // products of so many powers lose no digits
    at_lags_.resize(gammas_.size());
    for (std::int64_t done = 0; done < count; done += kAtOnce) {
      const std::int64_t now = std::min(kAtOnce, count - done);
      const auto begin = static_cast<double>(from + done);
      for (std::size_t p = 0; p < gammas_.size(); ++p) {
        at_lags_[p].resize(static_cast<std::size_t>(now));
        gammas_[p].at_lags(begin, at_lags_[p]);
      }
      for (std::int64_t i = 0; i < now; ++i) {
        for (std::size_t p = 0; p < gammas_.size(); ++p)
          values_(static_cast<Eigen::Index>(p)) = at_lags_[p][static_cast<std::size_t>(i)];
        add(begin + static_cast<double>(i), 1.0);
      }
    }
  }

  void add_panel(double from, std::int64_t points) {
    const DiscreteRule rule = discrete_rule(points);
    at_nodes_.clear();
    for (ScaleCovariance& gamma : gammas_) at_nodes_.push_back(gamma.at_nodes(from, points, rule));
    for (std::size_t i = 0; i < DiscreteRule::kOrder; ++i) {
      for (std::size_t p = 0; p < gammas_.size(); ++p)
        values_(static_cast<Eigen::Index>(p)) = at_nodes_[p][i];
      add(from + rule.nodes[i], rule.weights[i]);
    }
  }

  // The values at a lag.
  void add(double s, double weight) {
    const double pairs =
        std::min(samples_, samples_ - s) - std::max(2.0 * mk_, 2.0 * mj_ - s) + 1.0;
    for (Eigen::Index p = 0; p < values_.size(); ++p) {
      const double weighted = weight * pairs * values_(p);
      plain(p) += weighted;
      for (Eigen::Index q = 0; q <= p; ++q) products(p, q) += weighted * values_(q);
    }
  }

  double panel_limit(double distance) const {
    double limit = 1e300;
    for (const ScaleCovariance& gamma : gammas_) {
      limit = std::min(limit, gamma.panel_limit(distance));
    }
    return limit;
  }

  double samples_;
  double mj_;
  double mk_;
  std::vector<ScaleCovariance>& gammas_;
  Eigen::VectorXd values_;
  std::vector<ScaleCovariance::AtNodes> at_nodes_;
  std::vector<std::vector<double>> at_lags_;
  std::int64_t reach_ = 0;
};

// Lags at which a sum begins, ends or has a kink, ascending; the last is one past the end.
std::vector<std::int64_t> break_points(std::int64_t mj, std::int64_t mk, std::int64_t samples,
                                       std::int64_t tail) {
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
  return kinks;
}

}  // namespace

LagSums::LagSums(std::span<const SumCovariance> processes, const Scales& scales,
                 std::size_t samples)
    : entries_(scales.size() * (scales.size() + 1) / 2) {
  assert(scales.empty() || static_cast<std::size_t>(2 * scales.largest()) <= samples);
  const auto total = static_cast<std::int64_t>(samples);
  const auto count = [&](std::int64_t m) { return static_cast<double>(total - 2 * m + 1); };
  std::vector<LagTable> tables;
  for (const SumCovariance& process : processes) tables.emplace_back(process, samples);
  // Rows are unequal in cost: hand out the longest first.
  for_each_index(scales.size(), [&](std::size_t row) {
    const std::size_t j = scales.size() - 1 - row;
    for (std::size_t k = 0; k <= j; ++k) {
      std::vector<ScaleCovariance> gammas;
      double tail = 0.0;
      for (std::size_t p = 0; p < processes.size(); ++p) {
        gammas.emplace_back(processes[p], scales[j], scales[k], &tables[p]);
        tail = std::max(tail, gammas.back().tail_reach());
      }
      const auto reach = static_cast<std::int64_t>(std::min(tail, static_cast<double>(samples)));
      const std::vector<std::int64_t> breaks = break_points(scales[j], scales[k], total, reach);
      Summation sum(total, scales[j], scales[k], gammas);
      for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
        sum.add_interval(breaks[i], breaks[i + 1]);
      }
      const double pairs = count(scales[j]) * count(scales[k]);
      Entry& out = entries_[j * (j + 1) / 2 + k];
      out.products = sum.products.selfadjointView<Eigen::Lower>();
      out.products /= pairs;
      out.plain = sum.plain / pairs;
    }
  });
}

}  // namespace imunoise
