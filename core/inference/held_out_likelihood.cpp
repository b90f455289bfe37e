#include "core/inference/held_out_likelihood.h"

#include <algorithm>
#include <numeric>

namespace imunoise {
namespace {

BandedPower rows_of(const BandedPower& whole, std::size_t first, std::size_t step) {
  const auto begin = static_cast<Eigen::Index>(first);
  const auto by = static_cast<Eigen::Index>(step);
  const Eigen::Index rows = (whole.frequency.size() - begin + by - 1) / by;
  const auto pick = [&](const Eigen::ArrayXd& from) -> Eigen::ArrayXd {
    return from(Eigen::seqN(begin, rows, by));
  };
  return {
      pick(whole.frequency.cycles()), pick(whole.count), pick(whole.power), pick(whole.ramp_cross),
      pick(whole.ramp_power),         whole.samples,     whole.rate};
}

}  // namespace

double HeldOutFit::total() const { return std::accumulate(nats.begin(), nats.end(), 0.0); }

HeldOutFit held_out_fit(const Model& start, std::span<const BandedPower> parts) {
  HeldOutFit out{whittle(start, parts).model, {}};
  for (std::size_t k = 0; k < parts.size(); ++k) {
    std::vector<BandedPower> others(parts.begin(), parts.end());
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    const Model fitted = whittle(out.model, others).model;
    out.nats.push_back(-whittle_objective(fitted, parts.subspan(k, 1)));
  }
  return out;
}

std::vector<BandedPower> dealt_out(const BandedPower& whole, std::size_t parts) {
  std::vector<BandedPower> out;
  for (std::size_t k = 0; k < parts; ++k) out.push_back(rows_of(whole, k, parts));
  return out;
}

std::size_t simplest_of_best(std::span<const HeldOutFit> fits) {
  double best = fits[0].total();
  for (const HeldOutFit& one : fits) best = std::max(best, one.total());
  std::size_t out = fits.size();
  for (std::size_t i = 0; i < fits.size(); ++i) {
    if (!(fits[i].total() >= best - kClearNats)) continue;
    const auto size = [&](std::size_t at) { return parameter_count(fits[at].model); };
    const bool simpler = out == fits.size() || size(i) < size(out) ||
                         (size(i) == size(out) && fits[i].total() > fits[out].total());
    if (simpler) out = i;
  }
  return out;
}

}  // namespace imunoise
