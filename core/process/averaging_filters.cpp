#include "core/process/averaging_filters.h"

#include <cmath>
#include <numbers>

namespace imunoise {
namespace {

double square(double x) { return x * x; }

// n over 3.
double choose_three(double n) { return n < 3.0 ? 0.0 : n * (n - 1.0) * (n - 2.0) / 6.0; }

}  // namespace

std::vector<double> boxcar_taps(int n) {
  return std::vector<double>(static_cast<std::size_t>(n), 1.0 / n);
}

std::vector<double> boxcar_autocovariance(int n) {
  std::vector<double> out;
  for (int h = 0; h < n; ++h) out.push_back((n - h) / square(n));
  return out;
}

double boxcar_gain(int n, double f) {
  const double whole = std::sin(std::numbers::pi * f);
  if (std::abs(whole) < 1e-9) return 1.0;  // to within (nπf)²/3 of it, rounding for all n allowed
  return square(std::sin(std::numbers::pi * f * n) / (n * whole));
}

std::vector<double> bartlett_taps(int n) {
  std::vector<double> out;
  for (int i = 1 - n; i < n; ++i) {
    out.push_back(static_cast<double>(n - (i < 0 ? -i : i)) / (static_cast<double>(n) * n));
  }
  return out;
}

// The coefficients of z^h in [(1 - zⁿ)/(n(1 - z))]⁴ zᶜ, c = 2 - 2n: 1/(1 - z)⁴ has the coefficients
// k + 3 over 3, and of (1 - zⁿ)⁴ only 1 - 4zⁿ reaches lags h ≥ 0.
std::vector<double> bartlett_autocovariance(int n) {
  std::vector<double> out;
  for (int h = 0; h < 2 * n - 1; ++h) {
    out.push_back((choose_three(2 * n + 1 - h) - 4.0 * choose_three(n + 1 - h)) /
                  square(square(n)));
  }
  return out;
}

double bartlett_gain(int n, double f) { return square(boxcar_gain(n, f)); }

}  // namespace imunoise
