#include "study/analysis/arrays/array_setup.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/effects/parse_full_model.h"
#include "study/analysis/prepare.h"

namespace imunoise::study {
namespace {

Result<void> check_sensors(const std::vector<Series>& sensors) {
  if (sensors.size() < 2) {
    return fail("an array needs at least two sensors: name more channels, or use imunoise fit");
  }
  const Quantity first = sensors.front().replicates.front().quantity();
  for (const Series& one : sensors) {
    const Quantity quantity = one.replicates.front().quantity();
    if (quantity == first) continue;
    return fail(fmt::format(
        "{} is in {} and {} is in {}: the sensors of an array measure the same thing; choose them "
        "with --channel",
        sensors.front().channel, si_symbol(first), one.channel, si_symbol(quantity)));
  }
  return {};
}

Result<Measured> measure_array(const std::vector<Series>& sensors, int per_octave,
                               const Progress& progress) {
  Measured out;
  const std::size_t count = sensors.front().replicates.size();
  for (std::size_t k = 0; k < count; ++k) {
    std::vector<Signal> signals;
    for (const Series& one : sensors) signals.push_back(one.replicates[k]);
    const auto share = [&](std::size_t i) {
      return static_cast<double>(i) / static_cast<double>(count);
    };
    out.push_back(wavelet_covariance(signals,
                                     Scales::for_samples(signals.front().size(), per_octave),
                                     progress.part(share(k), share(k + 1))));
    if (out.back().scales.empty()) {
      return fail(
          fmt::format("{}: too short: at least 4 samples are needed", sensors.front().names[k]));
    }
    if (progress.stopped()) return fail("stopped");
    for (std::size_t i = 0; i < sensors.size(); ++i) {
      if (!signals[i].never_changes()) continue;
      return fail(
          fmt::format("{}: {} never changes: the sensor is stuck or was not connected; "
                      "leave it out with --channel",
                      sensors[i].names[k], sensors[i].channel));
    }
  }
  return out;
}

}  // namespace

Result<ArrayLayout> layout_of(const std::vector<Series>& sensors,
                              const std::vector<std::vector<std::string>>& groups,
                              const Model& written) {
  ArrayLayout out{sensors.size(), std::vector<std::size_t>(sensors.size(), groups.size())};
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (const std::string& name : groups[g]) {
      const auto found = std::find_if(sensors.begin(), sensors.end(),
                                      [&](const Series& s) { return s.channel == name; });
      if (found == sensors.end()) {
        return fail(fmt::format("group: there is no sensor '{}' among those analysed", name));
      }
      std::size_t& group = out.group[static_cast<std::size_t>(found - sensors.begin())];
      if (group != groups.size()) return fail(fmt::format("group: '{}' is in two groups", name));
      group = g;
    }
  }
  const bool shared = std::any_of(written.terms.begin(), written.terms.end(),
                                  [](const Term& term) { return term.sharing == Sharing::kGroup; });
  if (!groups.empty() && !shared)
    return fail(
        fmt::format("group: {} has no process that the sensors of a group share, such as "
                    "AR1[group]",
                    print(written)));
  return out;
}

Result<ArraySetup> array_setup(const std::vector<Series>& sensors, std::string_view model,
                               const std::vector<std::vector<std::string>>& groups, int per_octave,
                               const Progress& progress) {
  if (auto good = check_sensors(sensors); !good) return tl::unexpected(good.error());
  const Result<Model> written =
      parse_noise_model(model, sensors.front().replicates.front().rate(), grammar_of_arrays());
  if (!written) return tl::unexpected(written.error());
  const Result<ArrayLayout> layout = layout_of(sensors, groups, *written);
  if (!layout) return tl::unexpected(layout.error());
  Result<Measured> measured = measure_array(sensors, per_octave, progress);
  if (!measured) return tl::unexpected(measured.error());
  const std::size_t scales = measured->front().scales.size();
  if (free_parameters(*written) > scales) {
    return fail(fmt::format(
        "model: {} has {} free parameters per sensor, but the recording has only {} scales; use a "
        "smaller model, record longer, or use more scales per octave",
        print(*written), free_parameters(*written), scales));
  }
  return ArraySetup{*written, *layout, std::move(*measured)};
}

}  // namespace imunoise::study
