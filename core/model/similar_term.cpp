#include "core/model/similar_term.h"

#include <cmath>

namespace imunoise {
namespace {

Process of_unit_power(Process process) {
  std::vector<double> numbers = values(process);
  numbers.front() = 1.0;
  set_values(process, numbers);
  return process;
}

// By how many decades two spectra differ, root of the mean square over all decades, whatever their
// powers.
double difference_of_shape(const Process& a, const Process& b) {
  constexpr Eigen::Index kPlaces = 32;
  constexpr double kSlowest = 1e-7;  // cycles per sample
  const Frequencies all(0.5 *
                        Eigen::ArrayXd::LinSpaced(kPlaces, std::log(2.0 * kSlowest), 0.0).exp());
  const Eigen::ArrayXd decades =
      (spectrum(of_unit_power(a), all) / spectrum(of_unit_power(b), all)).log10();
  return std::sqrt((decades - decades.mean()).square().mean());
}

}  // namespace

std::optional<std::size_t> similar_term(const Model& model, const Process& process,
                                        const std::function<bool(std::size_t)>& allowed) {
  std::optional<std::size_t> out;
  double nearest = INFINITY;
  for (std::size_t t = 0; t < model.terms.size(); ++t) {
    const Process& one = model.terms[t].process;
    if (one.index() != process.index() || !allowed(t)) continue;
    const double away = difference_of_shape(one, process);
    if (out && !(away < nearest)) continue;
    out = t;
    nearest = away;
  }
  return out;
}

}  // namespace imunoise
