#include "core/effects/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/effects/simulate_effects.h"
#include "core/spectrum/cosine_transform.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

// Effects are numbered within a simulation: those of other streams have another seed.
constexpr std::uint64_t kGoldenRatio = 0x9e3779b97f4a7c15U;

double mean_of(const std::vector<double>& samples) {
  return std::accumulate(samples.begin(), samples.end(), 0.0) / static_cast<double>(samples.size());
}

// The samples of a witness, mean zero; what a quick transform needs more of runs back from the end.
Eigen::VectorXd prolonged(const std::vector<double>& samples, Index length) {
  const auto n = static_cast<Index>(samples.size());
  Eigen::VectorXd out(length);
  out.head(n) = Eigen::Map<const Eigen::VectorXd>(samples.data(), n);
  out.array() -= out.head(n).mean();
  out.tail(length - n) = out.segment(2 * n - length, length - n).reverse().eval();
  return out;
}

Subject empty_subject(const SimulationSize& size, const std::vector<SimulatedWitness>& witnesses) {
  Subject out{size.rate, Quantity::kUnknown, {}, {}, uncut(size.replicates), {}};
  const SharedVector zero(
      Eigen::VectorXd::Zero(static_cast<Index>(next_quick_length(size.samples))));
  out.samples.assign(size.replicates, zero);
  for (const SimulatedWitness& one : witnesses) {
    Witness& to = out.witnesses.emplace_back();
    to.name = one.name;
    to.samples.resize(size.replicates);
    to.cosines.resize(size.replicates);
  }
  return out;
}

}  // namespace

Result<Simulation> Simulation::make(FullModel model, SimulationSize size, std::uint64_t seed,
                                    std::vector<SimulatedWitness> witnesses) {
  if (!complete(model.noise))
    return fail(fmt::format("model: {} leaves values open; give each, as in WN(sigma2=1e-6)",
                            print(model.noise)));
  Simulation out;
  out.empty_ = empty_subject(size, witnesses);
  if (auto possible = check_simulation(model.effects, out.empty_); !possible)
    return tl::unexpected(possible.error());
  out.model_ = std::move(model);
  out.size_ = size;
  out.seed_ = seed;
  out.witnesses_ = std::move(witnesses);
  for (std::size_t w = 0; w < out.witnesses_.size(); ++w)
    out.empty_.witnesses[w].levels.assign(size.replicates, mean_of(out.witnesses_[w].samples(0)));
  return out;
}

SimulatedSamples Simulation::replicate(std::uint32_t number) const {
  SimulatedSamples out{simulate(model_.noise, size_.samples, seed_, size_.first_stream + number),
                       {}};
  Subject beside = empty_;
  for (std::size_t w = 0; w < witnesses_.size(); ++w) {
    out.witnesses.push_back(witnesses_[w].samples(number));
    Eigen::VectorXd samples = prolonged(out.witnesses[w], beside.length(number));
    beside.witnesses[w].levels[number] = mean_of(out.witnesses[w]);
    beside.witnesses[w].cosines[number] = cosine_transform(samples);
    beside.witnesses[w].samples[number] = std::move(samples);
  }
  if (model_.effects.empty()) return out;
  Eigen::VectorXd x = Eigen::VectorXd::Zero(beside.length(number));
  std::copy(out.channel.begin(), out.channel.end(), x.data());
  const std::uint64_t seed = seed_ + kGoldenRatio * size_.first_stream;
  simulate_effects(model_.effects, beside, number, seed, x);
  std::copy_n(x.data(), out.channel.size(), out.channel.begin());
  return out;
}

}  // namespace imunoise
