#include "core/support/roots.h"

#include <boost/math/tools/roots.hpp>
#include <cstdint>

namespace imunoise {

double root_by_newton(const std::function<std::pair<double, double>(double)>& f, double guess,
                      double low, double high) {
  constexpr int kBits = 26;  // of the last step but one: the next has twice as many
  return boost::math::tools::newton_raphson_iterate(f, guess, low, high, kBits);
}

double root_between(const std::function<double(double)>& f, double low, double high) {
  constexpr int kBits = 50;
  std::uintmax_t rounds = 200;
  const auto [left, right] = boost::math::tools::toms748_solve(
      f, low, high, boost::math::tools::eps_tolerance<double>(kBits), rounds);
  return 0.5 * (left + right);
}

}  // namespace imunoise
