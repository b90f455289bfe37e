#include "core/estimate/sharp_peaks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace imunoise {
namespace {

// Half the distance of the middles of bands next to a frequency, the widest of all replicates, rad
// per sample.
double half_band(std::span<const BandedPower> replicates, double omega) {
  double out = 0.0;
  for (const BandedPower& one : replicates) {
    if (one.frequency.size() < 2) continue;
    const Eigen::ArrayXd& middle = one.frequency.cycles();
    const double* const last = middle.data() + middle.size() - 1;
    const double* const at =
        std::lower_bound(middle.data() + 1, last, omega / (2.0 * std::numbers::pi));
    out = std::max(out, std::numbers::pi * (*at - *(at - 1)));
  }
  return out;
}

// The parameter that a peak's width follows, and the way in which it becomes sharper.
struct Decay {
  std::size_t parameter;
  double sharper;
};
std::optional<Decay> decay_of(const Process& process) {
  const bool rings =
      std::holds_alternative<Resonance>(process) || std::holds_alternative<Voigt>(process);
  if (rings) return Decay{1, +1.0};
  if (std::holds_alternative<Ar2>(process)) return Decay{2, -1.0};
  return std::nullopt;
}

template <class Peak>
void widen(Peak& peak, std::span<const BandedPower> replicates) {
  peak.r = std::min(peak.r, std::exp(-half_band(replicates, peak.omega)));
}

// Two real roots are no peak; complex ones keep their angle.
void widen(Ar2& from, std::span<const BandedPower> replicates) {
  if (!(from.phi1() * from.phi1() + 4.0 * from.phi2 < 0.0)) return;
  const double r = std::sqrt(-from.phi2);
  const double cosine = from.phi1() / (2.0 * r);
  const double most = std::exp(-half_band(replicates, std::acos(cosine)));
  if (r <= most) return;
  from.phi2 = -most * most;
  from.rho1 = 2.0 * most * cosine / (1.0 + most * most);
}

double value_of(const Model& model, const ParameterPlace& place) {
  return values(model.terms[place.term].process)[place.parameter];
}

}  // namespace

void widen_peaks(Model& model, std::span<const BandedPower> replicates) {
  for (Term& term : model.terms) {
    const std::optional<Decay> decay = decay_of(term.process);
    if (!decay || term.given[decay->parameter]) continue;
    if (auto* const sharp = std::get_if<Resonance>(&term.process)) widen(*sharp, replicates);
    if (auto* const spread = std::get_if<Voigt>(&term.process)) widen(*spread, replicates);
    // The angle of its roots is in both parameters.
    if (auto* const two = std::get_if<Ar2>(&term.process); two != nullptr && !term.given[1])
      widen(*two, replicates);
  }
}

void hold_at_limit(const Model& asked, const Model& widened,
                   const std::vector<ParameterPlace>& coordinates, Curvature& to) {
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const ParameterPlace& place = coordinates[i];
    const std::optional<Decay> decay = decay_of(asked.terms[place.term].process);
    if (!decay || decay->parameter != place.parameter) continue;
    const auto at = static_cast<Eigen::Index>(i);
    const bool at_limit = value_of(asked, place) != value_of(widened, place);
    if (!at_limit || !(decay->sharper * to.score(at) > 0.0)) continue;
    to.score(at) = 0.0;
    for (Eigen::MatrixXd* const one : {&to.information, &to.correction}) {
      if (one->size() == 0) continue;
      one->row(at).setZero();
      one->col(at).setZero();
    }
    to.information(at, at) = 1.0;
  }
}

}  // namespace imunoise
