#include "study/analysis/covariate_data.h"

#include <fmt/format.h>

#include <algorithm>

#include "study/words/number.h"

namespace imunoise::study {
namespace {

Result<std::size_t> find_channel(const recording::Replicate& recording, const std::string& name) {
  std::string known;
  for (std::size_t i = 0; i < recording.channels.size(); ++i) {
    if (recording.channels[i].name == name) return i;
    known += (known.empty() ? "" : ", ") + recording.channels[i].name;
  }
  return fail(fmt::format("covariate: there is no channel '{}' in {} (it has: {})", name,
                          recording.name, known));
}

// In the unit that the channel states.
std::vector<double> numbers_of(const recording::Channel& channel) {
  const Signal signal = channel.signal();
  std::vector<double> out(signal.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = (signal.value(i) - channel.unit.si_offset) / channel.unit.to_si;
  }
  return out;
}

std::string in_unit(double value, const std::string& unit) {
  return report::brief(value, 4) + (unit == "1" ? "" : " " + unit);
}

}  // namespace

Result<CovariateData> covariate_data(const std::vector<recording::Replicate>& recordings,
                                     const CovariateOptions& options) {
  const Result<std::size_t> channel = find_channel(recordings.front(), options.channel);
  if (!channel) return tl::unexpected(channel.error());
  std::vector<std::vector<double>> values;
  for (const recording::Replicate& one : recordings) {
    values.push_back(numbers_of(one.channels[*channel]));
  }
  const recording::Channel& first = recordings.front().channels[*channel];
  CovariateData out{options.channel, options.unit, {}};
  if (out.unit.empty()) out.unit = first.unit.symbol.empty() ? "1" : first.unit.symbol;
  BinOptions how{options.values, options.count};
  how.settle = static_cast<std::size_t>(options.settle_s * first.rate.value + 0.5);
  out.bins = bin_by_covariate(values, how);
  if (out.bins.bins.size() >= 2) return out;
  double low = values.front().front();
  double high = low;
  for (const std::vector<double>& one : values) {
    const auto [least, most] = std::minmax_element(one.begin(), one.end());
    low = std::min(low, *least);
    high = std::max(high, *most);
  }
  return fail(fmt::format(
      "covariate: {} lies between {} and {}, and {} a place where it stays for {} samples or more; "
      "at least two are needed. {} with --bins",
      out.name, in_unit(low, out.unit), in_unit(high, out.unit),
      out.bins.bins.empty() ? "nowhere is" : "only one is", kLeastRun,
      options.values.empty() ? "Record where it differs, or set the places"
                             : "Set places where it lies"));
}

Result<std::vector<CovariateBin>> measure_bins(const Series& series, const CovariateData& covariate,
                                               const MeasureOptions& options,
                                               const Progress& progress) {
  std::vector<CovariateBin> out;
  const std::vector<Bin>& bins = covariate.bins.bins;
  for (std::size_t b = 0; b < bins.size(); ++b) {
    Series runs;
    runs.channel = series.channel;
    for (const Run& run : bins[b].runs) {
      runs.names.push_back(series.names[run.recording]);
      runs.replicates.push_back(series.replicates[run.recording].part(run.begin, run.count));
    }
    const auto share = [&](std::size_t i) {
      return static_cast<double>(i) / static_cast<double>(bins.size());
    };
    auto measured = measure(runs, options, progress.part(share(b), share(b + 1)));
    if (!measured) return tl::unexpected(measured.error());
    const bool still = std::all_of(runs.replicates.begin(), runs.replicates.end(),
                                   [](const Signal& one) { return one.never_changes(); });
    if (still) {
      return fail(fmt::format(
          "{} never changes where {} is about {}: the sensor is stuck there or was not connected; "
          "leave that place out with --bins, or the channel with --channel",
          series.channel, covariate.name, in_unit(bins[b].mean, covariate.unit)));
    }
    out.push_back({bins[b].mean, std::move(*measured)});
  }
  return out;
}

}  // namespace imunoise::study
