#include "core/effect/subject.h"

#include <algorithm>
#include <cassert>

#include "core/spectrum/cosine_transform.h"
#include "core/spectrum/cross_power.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

// `mean`: what was taken off.
Eigen::VectorXd centred_samples(const Signal& signal, double& mean) {
  Eigen::VectorXd out = samples_of(signal);  // from the first sample on
  const double rest = out.mean();
  mean = signal.value(0) + rest;
  out.array() -= rest;
  return out;
}

}  // namespace

std::string unit_of(const Witness& witness) {
  return witness.unit.empty() ? std::string(si_symbol(witness.quantity)) : witness.unit;
}

std::string in_brackets(const std::string& unit) {
  return unit.find('/') == std::string::npos || unit.front() == '(' ? unit : "(" + unit + ")";
}

std::string per(const std::string& above, const std::string& below) {
  if (below == above) return "1";
  return below == "1" ? above : above + "/" + in_brackets(below);
}

const Witness* Subject::find(const std::string& name) const {
  const auto called = std::find_if(witnesses.begin(), witnesses.end(),
                                   [&](const Witness& one) { return one.name == name; });
  return called == witnesses.end() ? nullptr : &*called;
}

std::optional<std::size_t> Subject::around(std::size_t recorded, Eigen::Index sample) const {
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const Eigen::Index after = sample - parts[k].first;
    if (parts[k].recorded == recorded && after > 0 && after < length(k)) return k;
  }
  return std::nullopt;
}

void Subject::keep(const EffectTerm& term, std::shared_ptr<const Found> what) {
  std::erase_if(found, [&](const auto& one) { return one.first == term; });
  found.emplace_back(term, std::move(what));
}

std::vector<Part> uncut(std::size_t replicates) {
  std::vector<Part> out(replicates);
  for (std::size_t k = 0; k < replicates; ++k) out[k].recorded = k;
  return out;
}

Subject make_subject(const std::vector<Signal>& replicates,
                     const std::vector<NamedChannel>& witnesses, std::vector<Part> parts,
                     const Progress& progress) {
  assert(!replicates.empty());
  const std::size_t count = replicates.size();
  if (parts.empty()) parts = uncut(count);
  assert(parts.size() == count);
  Subject out{replicates[0].rate(), replicates[0].quantity(), {}, {}, std::move(parts), {}};
  out.samples.resize(count);
  out.cosines.resize(count);
  for (const NamedChannel& channel : witnesses) {
    assert(channel.replicates.size() == count);
    out.witnesses.push_back({channel.name, channel.replicates[0].quantity(),
                             std::vector<SharedVector>(count), std::vector<SharedVector>(count),
                             channel.unit, std::vector<double>(count)});
  }
  // One task a channel and replicate; the channel under study comes first.
  for_each_index((1 + witnesses.size()) * count, [&](std::size_t task) {
    if (progress.stopped()) return;
    const std::size_t k = task % count;
    const std::size_t channel = task / count;
    auto& samples = channel == 0 ? out.samples[k] : out.witnesses[channel - 1].samples[k];
    auto& cosines = channel == 0 ? out.cosines[k] : out.witnesses[channel - 1].cosines[k];
    double own = 0.0;  // the bias of a replicate tells nothing
    double& mean = channel == 0 ? own : out.witnesses[channel - 1].levels[k];
    samples =
        centred_samples(channel == 0 ? replicates[k] : witnesses[channel - 1].replicates[k], mean);
    cosines = cosine_transform(samples);
  });
  std::erase_if(out.witnesses, [&](const Witness& one) {
    const bool still =
        std::all_of(one.samples.begin(), one.samples.end(),
                    [](const SharedVector& x) { return x.size() == 0 || x.isZero(0.0); });
    if (still) out.still.push_back({one.name, one.quantity, {}, {}, one.unit});
    return still;
  });
  return out;
}

}  // namespace imunoise
