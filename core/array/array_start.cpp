#include "core/array/array_start.h"

#include <algorithm>
#include <numeric>

#include "core/array/array_blocks.h"
#include "core/estimate/estimators.h"
#include "core/process/parameter_scale.h"

namespace imunoise {
namespace {

using Order = std::vector<std::size_t>;  // which fitted term stands for each written one

bool same_kind(const Term& a, const Term& b) {
  return a.process.index() == b.process.index() && a.given == b.given &&
         structure(a.process) == structure(b.process);
}

// Every order of the written terms that only exchanges terms of a kind which are shared
// differently.
std::vector<Order> orders(const Model& written) {
  Order order(written.terms.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<Order> out;
  do {
    bool good = true;
    for (std::size_t t = 0; t < order.size() && good; ++t) {
      good = same_kind(written.terms[t], written.terms[order[t]]);
      for (std::size_t u = 0; u < t && good; ++u) {  // equals stay in ascending order
        good = !(written.terms[u] == written.terms[t]) || order[u] < order[t];
      }
    }
    if (good) out.push_back(order);
  } while (written.terms.size() <= 8 && std::next_permutation(order.begin(), order.end()));
  return out;
}

// Mean of a parameter on its scale over the processes that were seen, or over all of them.
double mean_value(const std::vector<Process>& from, const ParameterInfo& about, std::size_t p) {
  const ParameterScale scale(about, p);
  double seen = 0.0;
  double sum = 0.0;
  double all = 0.0;
  for (const Process& process : from) {
    const std::vector<double> v = values(process);
    const double at = scale.to_scale(std::clamp(v[p], about.lower, about.upper));
    all += at;
    if (v[0] > 0.0) {
      sum += at;
      seen += 1.0;
    }
  }
  return scale.to_value(seen > 0.0 ? sum / seen : all / static_cast<double>(from.size()));
}

}  // namespace

std::vector<ArrayModel> array_starts(const Model& written, const ArrayModel& open,
                                     std::span<const WaveletCovariance> replicates) {
  Model single = written;
  bool shapes = false;
  for (Term& term : single.terms) {
    term.sharing = Sharing::kOwn;
    shapes =
        shapes || std::find(term.given.begin() + 1, term.given.end(), false) != term.given.end();
  }
  if (!shapes) return {open};
  std::vector<Model> fitted;
  for (Eigen::Index i = 0; i < open.sensors; ++i) {
    std::vector<WaveletVariance> own;
    for (const WaveletCovariance& one : replicates) own.push_back(own_variance(one, i));
    fitted.push_back(mugmwm(single, own, Weighting::kFull).model);
  }
  std::vector<ArrayModel> out;
  for (const Order& order : orders(written)) {
    ArrayModel start = open;
    for (Latent& latent : start.latents) {
      std::vector<Process> from;
      for (const Eigen::Index i : latent.sensors) {
        from.push_back(fitted[static_cast<std::size_t>(i)].terms[order[latent.written]].process);
      }
      const std::vector<ParameterInfo> about = parameters(latent.term.process);
      std::vector<double> v = values(latent.term.process);
      for (std::size_t p = 1; p < v.size(); ++p) {
        if (!latent.term.given[p]) v[p] = mean_value(from, about[p], p);
      }
      set_values(latent.term.process, v);
    }
    out.push_back(std::move(start));
  }
  return out;
}

}  // namespace imunoise
