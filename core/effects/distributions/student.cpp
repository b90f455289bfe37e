#include "core/effects/distributions/student.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/effects/draws.h"
#include "core/search/peak.h"
#include "core/support/distributions.h"

namespace imunoise {
namespace {

constexpr double kSmallest = 1e-3;
constexpr double kEachFactor = 64.0;  // places a factor e: sizes from 1e-3 to 9e3

// Log-likelihood of all sizes under a density.
template <class Density>
double likelihood_of(const SizeCounts& sizes, const Density& density) {
  double out = 0.0;
  for (std::size_t i = 0; i < sizes.count.size(); ++i) {
    if (sizes.count[i] > 0.0) out += sizes.count[i] * density(SizeCounts::size(i));
  }
  return out;
}

}  // namespace

std::size_t SizeCounts::place(double size) {
  const double at = kEachFactor * std::log(std::max(size, kSmallest) / kSmallest);
  return std::min(kSizes - 1, static_cast<std::size_t>(at));
}

double SizeCounts::size(std::size_t place) {
  return kSmallest * std::exp((static_cast<double>(place) + 0.5) / kEachFactor);
}

SizeCounts count_sizes(const std::vector<Eigen::VectorXd>& innovations) {
  SizeCounts out;
  for (const Eigen::VectorXd& white : innovations) {
    for (const double x : white) ++out.count[SizeCounts::place(std::abs(x))];
  }
  return out;
}

double log_density(const Student& student, double size) {
  const double half = 0.5 * (student.dof + 1.0);
  const double x = size / student.scale;
  return std::lgamma(half) - std::lgamma(0.5 * student.dof) -
         0.5 * std::log(student.dof * std::numbers::pi) - std::log(student.scale) -
         half * std::log1p(x * x / student.dof);
}

double log_normal_density(double size) {
  return -0.5 * (size * size + std::log(2.0 * std::numbers::pi));
}

Student student_of(const SizeCounts& sizes, double dof) {
  // Expectation and maximisation (Dempster, Laird & Rubin 1977).
  constexpr int kSteps = 60;
  double all = 0.0;
  for (const double count : sizes.count) all += count;
  double variance = 1.0;
  for (int step = 0; step < kSteps; ++step) {
    double sum = 0.0;
    for (std::size_t i = 0; i < sizes.count.size(); ++i) {
      const double square = SizeCounts::size(i) * SizeCounts::size(i);
      sum += sizes.count[i] * (dof + 1.0) / (dof + square / variance) * square;
    }
    const double before = variance;
    variance = sum / all;
    if (std::abs(variance - before) < 1e-9 * before) break;
  }
  return {dof, std::sqrt(variance)};
}

Student best_student(const SizeCounts& sizes) {
  constexpr double kLeast = 2.1;
  constexpr double kMost = 200.0;
  const Peak best = peak_between(std::log(kLeast), std::log(kMost), 0.1, [&](double logarithm) {
    return gain_of(sizes, student_of(sizes, std::exp(logarithm)));
  });
  return student_of(sizes, std::exp(best.at));
}

double gain_of(const SizeCounts& sizes, const Student& student) {
  double all = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < sizes.count.size(); ++i) {
    all += sizes.count[i];
    squares += sizes.count[i] * SizeCounts::size(i) * SizeCounts::size(i);
  }
  const double deviation = std::sqrt(squares / all);
  return likelihood_of(sizes, [&](double size) { return log_density(student, size); }) -
         likelihood_of(sizes, [&](double size) {
           return log_normal_density(size / deviation) - std::log(deviation);
         });
}

NormalFromStudent::NormalFromStudent(const Student& student) {
  constexpr double kSmallestLog = -650.0;  // of a number that a double holds
  // The tail of Student's distribution is half that of Fisher's with (1, dof) degrees of freedom.
  for (std::size_t i = 0; i < factor_.size(); ++i) {
    const double size = SizeCounts::size(i);
    const double x = size / student.scale;
    const double log_tail = log_f_tail(x * x, 1.0, student.dof) - std::numbers::ln2;
    factor_[i] = -normal_quantile(std::exp(std::max(log_tail, kSmallestLog))) / size;
  }
}

double NormalFromStudent::slope(const SizeCounts& sizes) const {
  const auto normal = [&](std::size_t i) { return factor_[i] * SizeCounts::size(i); };
  double sum = 0.0;
  double all = 0.0;
  for (std::size_t i = 1; i + 1 < factor_.size(); ++i) {
    sum += sizes.count[i] * (normal(i + 1) - normal(i - 1)) /
           (SizeCounts::size(i + 1) - SizeCounts::size(i - 1));
    all += sizes.count[i];
  }
  return sum / all;
}

double student_number(double dof, RandomStream& random) {
  // Bailey 1994, Math. Comp. 62:779: the polar method.
  for (;;) {
    const double u = 2.0 * uniform_number(random) - 1.0;
    const double v = 2.0 * uniform_number(random) - 1.0;
    const double w = u * u + v * v;
    if (!(w > 0.0 && w <= 1.0)) continue;
    const double t = u * std::sqrt(dof * std::expm1(-2.0 / dof * std::log(w)) / w);
    return t * std::sqrt((dof - 2.0) / dof);
  }
}

}  // namespace imunoise
