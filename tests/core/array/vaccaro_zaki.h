#pragma once

// The competitor: Vaccaro & Zaki 2017 (Sensors 17:352), Algorithms 1 and 2, written from the
// paper's equations. White noise variances R and random walk covariances Q of a gyro array by
// generalised least squares on Allan variances and covariances of windows that do not overlap.

#include <Eigen/Dense>
#include <cmath>
#include <vector>

namespace imunoise::testing {

struct VaccaroZaki {
  Eigen::VectorXd r;
  Eigen::MatrixXd q;
};

class VaccaroZakiEstimator {
 public:
  /// GLS(passes): the weights are made again from the estimates passes - 1 times.
  explicit VaccaroZakiEstimator(int passes) : passes_(passes) {}

  VaccaroZaki operator()(const std::vector<std::vector<double>>& sensors) const {
    const auto samples = static_cast<double>(sensors.front().size());
    std::vector<double> m;  // windows of 2, 4 .. 2^(J-3) samples
    for (double w = 2.0; 8.0 * w <= samples; w *= 2.0) m.push_back(w);
    const auto n = static_cast<Eigen::Index>(sensors.size());
    std::vector<Eigen::MatrixXd> allan;
    for (const double w : m)
      allan.push_back(allan_covariance(sensors, static_cast<std::size_t>(w)));
    const auto column = [&](Eigen::Index a, Eigen::Index b) {
      Eigen::VectorXd out(static_cast<Eigen::Index>(m.size()));
      for (std::size_t i = 0; i < m.size(); ++i) out(static_cast<Eigen::Index>(i)) = allan[i](a, b);
      return out;
    };
    VaccaroZaki out{Eigen::VectorXd(n), Eigen::MatrixXd(n, n)};
    for (Eigen::Index a = 0; a < n; ++a) {
      const Eigen::Vector2d qr = single(m, samples, column(a, a));
      out.q(a, a) = qr(0);
      out.r(a) = qr(1);
    }
    for (Eigen::Index a = 0; a < n; ++a) {
      for (Eigen::Index b = a + 1; b < n; ++b) {
        double cross = 0.0;
        for (int pass = 0; pass < passes_; ++pass) {
          const Eigen::MatrixXd c =
              white_part(m, samples, 0.5 * out.r(a) * out.r(b)) +
              walk_part(m, samples, 0.5 * (out.q(a, a) * out.q(b, b) + cross * cross));
          const Eigen::VectorXd h =
              Eigen::Map<const Eigen::VectorXd>(m.data(), static_cast<Eigen::Index>(m.size())) /
              3.0;
          const Eigen::VectorXd weighted = c.ldlt().solve(h);
          cross = weighted.dot(column(a, b)) / weighted.dot(h);
        }
        out.q(a, b) = out.q(b, a) = cross;
      }
    }
    return out;
  }

 private:
  static Eigen::MatrixXd allan_covariance(const std::vector<std::vector<double>>& sensors,
                                          std::size_t m) {
    const auto n = static_cast<Eigen::Index>(sensors.size());
    const std::size_t windows = sensors.front().size() / m;
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd before(n);
    for (std::size_t w = 0; w < windows; ++w) {
      Eigen::VectorXd mean = Eigen::VectorXd::Zero(n);
      for (Eigen::Index i = 0; i < n; ++i) {
        const std::vector<double>& x = sensors[static_cast<std::size_t>(i)];
        for (std::size_t k = w * m; k < (w + 1) * m; ++k) mean(i) += x[k];
      }
      mean /= static_cast<double>(m);
      if (w > 0) out += (mean - before) * (mean - before).transpose();
      before = mean;
    }
    return out / (2.0 * static_cast<double>(windows - 1));
  }

  // Covariances of Allan variances at two window lengths: of white noise of R² = `square`, and of a
  // random walk of Q² = `square`.
  static Eigen::MatrixXd white_part(const std::vector<double>& m, double samples, double square) {
    return symmetric(m, [&](double m1, double m2) {
      const double p = m2 / m1;
      return (3.0 * samples / m2 - 4.0) /
             ((samples / m1 - 1.0) * (samples / m2 - 1.0) * p * p * m1 * m1) * square;
    });
  }
  static Eigen::MatrixXd walk_part(const std::vector<double>& m, double samples, double square) {
    return symmetric(m, [&](double m1, double m2) {
      const double p = m2 / m1;
      const double cube = p * p * p;
      return ((12.0 * cube - 6.0 * p + 3.0) * samples / m2 - 2.0 * (6.0 * cube - 3.0 * p + 2.0)) *
             m1 * m1 / (36.0 * (samples / m1 - 1.0) * (samples / m2 - 1.0) * p * p) * square;
    });
  }
  template <class Entry>
  static Eigen::MatrixXd symmetric(const std::vector<double>& m, const Entry& entry) {
    const auto n = static_cast<Eigen::Index>(m.size());
    Eigen::MatrixXd out(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index k = i; k < n; ++k) {
        out(i, k) = out(k, i) =
            entry(m[static_cast<std::size_t>(i)], m[static_cast<std::size_t>(k)]);
      }
    }
    return out;
  }

  // Q and R of one sensor.
  Eigen::Vector2d single(const std::vector<double>& m, double samples,
                         const Eigen::VectorXd& allan) const {
    Eigen::Index least = 0;
    allan.minCoeff(&least);
    const double m0 = m[static_cast<std::size_t>(least)];
    std::vector<double> white;  // where white noise is all there is
    for (const double w : m) {
      if (w < m0 / 8.0) white.push_back(w);
    }
    if (white.empty()) white.push_back(m.front());
    const auto few = static_cast<Eigen::Index>(white.size());
    const Eigen::VectorXd h = Eigen::Map<const Eigen::VectorXd>(white.data(), few).cwiseInverse();
    const Eigen::VectorXd weighted = white_part(white, samples, 1.0).ldlt().solve(h);
    double r = weighted.dot(allan.head(few)) / weighted.dot(h);
    double q = 3.0 * r / (m0 * m0);
    const auto n = static_cast<Eigen::Index>(m.size());
    Eigen::MatrixXd design(n, 2);
    design.col(0) = Eigen::Map<const Eigen::VectorXd>(m.data(), n) / 3.0;
    design.col(1) = Eigen::Map<const Eigen::VectorXd>(m.data(), n).cwiseInverse();
    for (int pass = 0; pass < passes_; ++pass) {
      const Eigen::MatrixXd c = white_part(m, samples, r * r) + walk_part(m, samples, q * q);
      const Eigen::MatrixXd solved = c.ldlt().solve(design);
      const Eigen::Vector2d qr =
          (design.transpose() * solved).ldlt().solve(solved.transpose() * allan);
      q = qr(0);
      r = qr(1);
    }
    return {q, r};
  }

  int passes_;
};

}  // namespace imunoise::testing
