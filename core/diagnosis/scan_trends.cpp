#include <algorithm>
#include <cmath>

#include "core/diagnosis/scan.h"
#include "core/diagnosis/slow_view.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

// Block means of a function of the time in s from the first sample of what was recorded.
template <class Function>
std::vector<Eigen::VectorXd> over_time(const Current& current, const SlowView& view,
                                       const Function& function) {
  const Subject& subject = current.subject();
  std::vector<Eigen::VectorXd> out;
  for (std::size_t k = 0; k < subject.replicates(); ++k) {
    const auto block = static_cast<double>(view.block(k));
    Eigen::VectorXd means(subject.length(k) / view.block(k));
    for (Index i = 0; i < means.size(); ++i)
      means(i) =
          function(subject.begins(k) + (static_cast<double>(i) + 0.5) * block / subject.rate.value);
    out.push_back(std::move(means));
  }
  return out;
}

}  // namespace

Suggestions scan_trends(const Current& current) {
  const SlowView view(current);
  const Subject& subject = current.subject();
  const auto replicates = static_cast<double>(subject.replicates());
  Suggestions out;
  for (const bool own : {false, true}) {
    if (own && subject.replicates() == 1) continue;
    const double dof = own ? replicates : 1.0;
    const Eigen::VectorXd ramp =
        view.whitened(over_time(current, view, [](double t) { return t; }));
    out.push_back({.effect = "rate_ramp",
                   .added = EffectTerm{.kind = EffectKind::kRamp, .own = own},
                   .score_nats = view.gain(ramp, own),
                   .dof = dof,
                   .information = ramp.squaredNorm()});

    // From a few blocks to half a replicate; longer is a ramp.
    const double longest = 0.5 * subject.seconds(0);
    const double shortest =
        std::max(4.0 * static_cast<double>(view.block(0)), 16.0) / subject.rate.value;
    if (shortest >= longest) continue;
    const SlowView::BestTime best = view.best_time(shortest, longest, own, [&](double tau) {
      return over_time(current, view, [&](double t) { return std::exp(-t / tau); });
    });
    if (!(best.gain > 0.0)) continue;
    out.push_back(
        {.effect = "warm_up",
         .added = EffectTerm{.kind = EffectKind::kWarmUp, .tau = best.seconds, .own = own},
         .score_nats = best.gain,
         .dof = dof,
         .search = {.path = best.path},
         .information = best.information,
         .shape_error = best.log_error});
  }
  return out;
}

}  // namespace imunoise
