#include "cli/simulated_witness.h"

#include <fmt/format.h>

#include <cmath>

#include "core/effects/parse_full_model.h"
#include "core/support/counted.h"
#include "recording/import/import.h"

namespace imunoise::cli {
namespace {

// Each witness has a seed of its own that follows from the simulation's.
std::uint64_t seed_of(std::uint64_t seed, std::size_t witness) {
  constexpr std::uint64_t kGoldenRatio = 0x9e3779b97f4a7c15U;
  return seed + kGoldenRatio * (witness + 1);
}

Error of_witness(const std::string& name, const std::string& what) {
  return {fmt::format("--witness {}: {}", name, what)};
}

Result<WrittenWitness> drawn(const WitnessArguments& witness, const SimulateArguments& size,
                             std::uint64_t seed) {
  const auto model = parse_noise_model(witness.model, size.rate,
                                       {.no_effects = "a simulated witness is noise alone"});
  if (!model) return tl::unexpected(of_witness(witness.name, model.error().message));
  if (!complete(*model))
    return tl::unexpected(of_witness(
        witness.name, print(*model) + " leaves values open; give each, as in RW(gamma2=1e-6)"));
  const auto samples = [noise = *model, n = size.samples, seed](std::uint32_t replicate) {
    return simulate(noise, n, seed, replicate);
  };
  return WrittenWitness{{witness.name, samples}, witness.unit};
}

Result<void> usable(const recording::Replicate& read, const SimulateArguments& size) {
  constexpr double kClockError = 1e-3;
  if (std::abs(read.rate.value - size.rate.value) > kClockError * size.rate.value)
    return fail(fmt::format("{} has a rate of {:g} Hz; simulate at --rate {:g}", read.name,
                            read.rate.value, read.rate.value));
  if (read.channels.front().count < size.samples)
    return fail(fmt::format("{} has {}; simulate at most so many", read.name,
                            counted(read.channels.front().count, "sample")));
  return {};
}

Result<WrittenWitness> recorded(const WitnessArguments& witness, const SimulateArguments& size) {
  if (witness.files.size() > 1 && witness.files.size() != size.replicates)
    return tl::unexpected(of_witness(
        witness.name,
        fmt::format("there are {} for {}; give one for all, or one for each",
                    counted(witness.files.size(), "file"), counted(size.replicates, "replicate"))));
  recording::ImportOptions options;
  options.channels = {witness.name};
  auto read = recording::import_files(witness.files, options);
  if (!read) return tl::unexpected(read.error());
  for (const recording::Replicate& one : *read) {
    if (auto good = usable(one, size); !good)
      return tl::unexpected(of_witness(witness.name, good.error().message));
  }
  const Unit unit = read->front().channels.front().unit;
  const auto samples = [each = *read, n = size.samples,
                        zero = unit.si_offset](std::uint32_t replicate) {
    const Signal signal = each[each.size() == 1 ? 0 : replicate].channels.front().signal();
    std::vector<double> out(n);
    for (std::size_t t = 0; t < n; ++t) out[t] = signal.value(t) - zero;
    return out;
  };
  return WrittenWitness{{witness.name, samples}, unit};
}

}  // namespace

Result<std::vector<WrittenWitness>> witnesses_of(const SimulateArguments& arguments) {
  std::vector<WrittenWitness> out;
  for (const WitnessArguments& one : arguments.witnesses) {
    auto made = one.files.empty() ? drawn(one, arguments, seed_of(arguments.seed, out.size()))
                                  : recorded(one, arguments);
    if (!made) return tl::unexpected(made.error());
    out.push_back(std::move(*made));
  }
  return out;
}

}  // namespace imunoise::cli
