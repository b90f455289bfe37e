#include "core/estimate/spectral_expansion.h"

#include "core/estimate/searched_parameter.h"

namespace imunoise {

SpectralExpansion::SpectralExpansion(const Process& process,
                                     const std::vector<std::size_t>& parameters,
                                     const Frequencies& frequency, Order order) {
  // Spectra are proportional to the power: those of power 1 say it all.
  Process unit = process;
  set_searched(unit, 0, 1.0);
  const double power = values(process)[0];
  const Eigen::ArrayXd here = spectrum(unit, frequency);
  const auto spectrum_at = [&](std::size_t p, std::size_t q, double step) {
    Process moved = unit;
    set_searched(moved, p, searched(unit, p) + step);
    if (q != p) set_searched(moved, q, searched(unit, q) + step);
    return spectrum(moved, frequency);
  };
  constexpr double kStep = 1e-4;
  std::vector<Eigen::ArrayXd> unit_slopes;
  std::vector<Eigen::ArrayXd> both_ways;  // what a step there and one back change together
  for (const std::size_t p : parameters) {
    if (p == 0) {
      unit_slopes.push_back(here);
      both_ways.emplace_back();
      slopes.push_back(here);
    } else {
      const Eigen::ArrayXd up = spectrum_at(p, p, kStep);
      const Eigen::ArrayXd down = spectrum_at(p, p, -kStep);
      unit_slopes.emplace_back((up - down) / (2.0 * kStep));
      both_ways.emplace_back(up + down - 2.0 * here);
      slopes.emplace_back(power * unit_slopes.back());
    }
    if (order == Order::kFirst) continue;
    const std::size_t i = slopes.size() - 1;
    for (std::size_t j = 0; j <= i; ++j) {
      const std::size_t q = parameters[j];
      if (p == 0 || q == 0) {
        bends.push_back(p == q ? Eigen::ArrayXd::Zero(here.size()) : unit_slopes[p == 0 ? j : i]);
      } else if (p == q) {
        bends.emplace_back(power * both_ways[i] / (kStep * kStep));
      } else {
        bends.emplace_back(power *
                           (spectrum_at(p, q, kStep) + spectrum_at(p, q, -kStep) - 2.0 * here -
                            both_ways[i] - both_ways[j]) /
                           (2.0 * kStep * kStep));
      }
    }
  }
}

}  // namespace imunoise
