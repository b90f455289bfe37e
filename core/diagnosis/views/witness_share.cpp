#include "core/diagnosis/views/witness_share.h"

#include <algorithm>
#include <cmath>

#include "core/diagnosis/views/lag_curves.h"
#include "core/diagnosis/views/sensor_pairs.h"
#include "core/search/evidence.h"
#include "core/support/roots.h"

namespace imunoise {
namespace {

// All that was tried, and the best of it.
struct Tried {
  double pairs = 0.0;           // half octaves of witnesses
  std::vector<double> paths{};  // of lags
  double nats = 0.0;
  std::string witness{};

  void offer(double gained, const std::string& name) {
    if (!(gained > nats)) return;
    nats = gained;
    witness = name;
  }
  // How many of them gain so much by chance.
  double expected(double gained) const {
    double out = pairs * std::exp(log_p_value(gained, 1.0, INFINITY, false));
    for (const double path : paths)
      out += std::exp(log_p_value(gained, 1.0, INFINITY, false, {path, 0.0}));
    return out;
  }
  // The nats that the best passes with a probability under a true model.
  double passed(double probability) const {
    constexpr double kMost = 300.0;  // nats: exp(-300) is still a number
    const double wanted = -std::log1p(-probability);
    if (expected(0.0) <= wanted) return 0.0;
    return root_between([&](double gained) { return std::log(expected(gained) / wanted); }, 0.0,
                        kMost);
  }
};

}  // namespace

std::optional<WitnessShare> witness_share(const Current& current) {
  const Subject& subject = current.subject();
  Tried tried;
  for (const SensorPair& one : witness_pairs(current)) {
    tried.pairs += static_cast<double>(one.places);
    tried.offer(0.5 * one.sigma * one.sigma, subject.witnesses[one.second - 1].name);
  }
  for (const LagCurve& one : lag_curves(current)) {
    tried.paths.push_back(one.path);
    tried.offer(*std::max_element(one.nats.begin(), one.nats.end()), one.witness);
  }
  if (tried.pairs == 0.0) return std::nullopt;
  double samples = 0.0;
  for (std::size_t k = 0; k < subject.replicates(); ++k)
    samples += static_cast<double>(subject.length(k));
  return WitnessShare{.witness = tried.witness,
                      .share = std::min(1.0, 2.0 * tried.nats / samples),
                      .chance_median = 2.0 * tried.passed(0.5) / samples,
                      .chance_limit = 2.0 * tried.passed(0.05) / samples,
                      .p_value = -std::expm1(-tried.expected(tried.nats))};
}

}  // namespace imunoise
