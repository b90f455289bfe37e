#include "study/calibration/calibrate.h"

#include <fmt/format.h>

#include <map>
#include <set>

#include "core/effects/parse_full_model.h"
#include "recording/import/table/names.h"
#include "recording/store/manifest/manifest.h"
#include "recording/store/reading/places.h"
#include "recording/store/reading/replicates.h"
#include "study/analysis/preflights.h"
#include "study/analysis/prepare.h"
#include "study/calibration/calibrate_array.h"
#include "study/calibration/calibrate_channel.h"
#include "study/calibration/calibration_file.h"
#include "study/report/view/verdict.h"

namespace imunoise::study {
namespace {

using recording::Replicate;

// A stream with the channels that are wanted of it.
using Task = recording::ImportedStream;

bool in_unit_of_inertia(const std::string& units) {
  const auto unit = parse_unit(units);
  return unit && of_inertia(unit->quantity);
}

Result<std::vector<Task>> tasks_of(const std::string& folder, const v1::Manifest& manifest,
                                   const std::vector<std::string>& wanted) {
  const auto chosen = recording::wanted_of(folder, recording::offers_of(manifest), wanted);
  if (!chosen) return tl::unexpected(chosen.error());
  std::set<std::string> named;
  for (const recording::Wanted& one : *chosen) named.insert(one.name);
  std::vector<Task> out;
  for (const Task& stream : recording::imported_streams(manifest)) {
    Task task{stream.device, stream.stream, {}};
    for (const recording::ImportedChannel& channel : stream.channels) {
      if (wanted.empty() ? in_unit_of_inertia(channel.units) : named.contains(channel.name))
        task.channels.push_back(channel);
    }
    if (!task.channels.empty()) out.push_back(std::move(task));
  }
  if (out.empty()) {
    return fail(fmt::format(
        "{}: no channel is an angular rate or an acceleration; name one with --channel ({})",
        folder, fmt::join(named, ", ")));
  }
  return out;
}

std::size_t devices_of(const std::vector<Task>& tasks) {
  std::set<std::string> names;
  for (const Task& one : tasks) names.insert(one.device);
  return names.size();
}

void name(const Task& task, auto& to) {
  to.set_device(task.device);
  to.set_stream(task.stream);
}

// A stream that cannot be read: every channel wanted of it says so.
void tell_unread(const Task& task, const Error& error, v1::Calibration& to) {
  for (const recording::ImportedChannel& channel : task.channels) {
    v1::ChannelCalibration& one = *to.add_channels();
    name(task, one);
    one.set_channel(channel.name);
    add_trouble("read", error, *one.mutable_troubles());
  }
}

void calibrate_stream(const Task& task, const std::vector<Replicate>& replicates,
                      const CalibrateOptions& options, const Progress& progress,
                      v1::Calibration& to) {
  std::vector<std::size_t> channels;
  for (const recording::ImportedChannel& one : task.channels)
    channels.push_back(channel_called(one.name, replicates.front()).value());
  const double arrays = options.array ? 0.9 : 1.0;  // where these begin
  for (std::size_t i = 0; i < channels.size() && !progress.stopped(); ++i) {
    const auto count = static_cast<double>(channels.size());
    const Progress part = progress.part(arrays * static_cast<double>(i) / count,
                                        arrays * static_cast<double>(i + 1) / count);
    v1::ChannelCalibration one = calibrate_channel(replicates, channels[i], options, part);
    name(task, one);
    one.set_channel(task.channels[i].name);
    *to.add_channels() = std::move(one);
  }
  if (!options.array || progress.stopped()) return;
  for (v1::ArrayCalibration& array :
       arrays_of_stream(replicates, channels, options, progress.part(arrays, 1.0))) {
    name(task, array);
    *to.add_arrays() = std::move(array);
  }
}

v1::CalibrationSettings settings_of(const CalibrateOptions& options) {
  v1::CalibrationSettings out;
  for (const std::string& model : options.models) out.add_models(model);
  for (const std::string& channel : options.channels) out.add_channels(channel);
  out.set_diagnose(options.diagnose);
  out.set_array(options.array);
  out.set_array_model(options.array_model.value_or(""));
  out.set_bootstrap_sets(static_cast<std::uint32_t>(options.bootstrap.sets));
  out.set_seed(options.bootstrap.seed);
  return out;
}

// " (WN + FN + RW fits (p = 0.4): gyro_x, gyro_y; ...)".
std::string missing_in(const v1::Calibration& calibration) {
  std::map<std::string, std::string> channels;
  for (const v1::ChannelCalibration& one : calibration.channels()) {
    // Channels that lack the same differ in their p-values.
    std::string what = one.missing().substr(0, one.missing().find(" (p"));
    if (what.empty()) continue;
    std::string& of = channels[std::move(what)];
    of += (of.empty() ? "" : ", ") + one.channel();
  }
  std::string out;
  for (const auto& [what, of] : channels)
    out += fmt::format("{}{}: {}", out.empty() ? "" : "; ", of, what);
  return out.empty() ? "" : fmt::format(" ({})", out);
}

// `effects` channels lack one, of `sought` that were searched, of `fitted`.
std::string effect_words(int effects, int sought, int fitted) {
  if (sought == 0) return "; missing effects were not sought";
  std::string out =
      effects == 0 ? "; no effect is missing"
                   : fmt::format("; {} {} an effect", effects, effects == 1 ? "lacks" : "lack");
  if (sought < fitted) out += fmt::format(" ({} of {} searched)", sought, fitted);
  return out;
}

std::string summary_of(const v1::Calibration& calibration) {
  int fitted = 0;
  int misfits = 0;
  int doubts = 0;
  int effects = 0;
  int sought = 0;
  int troubled = 0;
  for (const v1::ChannelCalibration& one : calibration.channels()) {
    fitted += one.has_fit() ? 1 : 0;
    if (one.has_fit()) {
      const report::Verdict verdict = report::verdict(one.fit());
      misfits += verdict == report::Verdict::kFails ? 1 : 0;
      doubts += verdict == report::Verdict::kDoubtful ? 1 : 0;
    }
    sought += one.has_diagnosis() ? 1 : 0;
    effects += one.has_diagnosis() && one.diagnosis().verdict() != v1::none ? 1 : 0;
    troubled += one.troubles().empty() ? 0 : 1;
  }
  std::string out =
      fmt::format("{} of {} channels have a model", fitted, calibration.channels_size());
  if (misfits > 0)
    out += fmt::format("; {} of these {} not fit{}", misfits, misfits == 1 ? "does" : "do",
                       missing_in(calibration));
  if (doubts > 0) out += fmt::format("; {} of these may not fit", doubts);
  if (fitted > 0 && misfits + doubts == 0) out += ", and every model fits";
  if (calibration.settings().diagnose() && fitted > 0) out += effect_words(effects, sought, fitted);
  if (troubled > 0) out += fmt::format("; {} had trouble", troubled);
  return out + ".";
}

}  // namespace

Result<void> check_models(const CalibrateOptions& options) {
  std::vector<FullModel> candidates;
  for (const std::string& one : options.models) {
    if (auto good = add_candidate(one, kAnyRate, "imunoise calibrate", candidates); !good)
      return good;
  }
  if (!options.array_model) return {};
  const auto array = parse_noise_model(*options.array_model, kAnyRate, grammar_of_arrays());
  if (!array) return tl::unexpected(array.error());
  return {};
}

Result<v1::Calibration> calibrate(const recording::FileSystem& files,
                                  const std::filesystem::path& folder,
                                  const CalibrateOptions& options, const Progress& progress) {
  const auto manifest = recording::read_manifest(files, folder);
  if (!manifest) return tl::unexpected(manifest.error());
  if (!*manifest) {
    return fail(folder.string() +
                ": is not a recording: it has no manifest.json (imunoise verify --repair makes one "
                "from chunks)");
  }
  // Before minutes are spent on reading.
  if (auto readable = check_models(options); !readable) return tl::unexpected(readable.error());
  const auto tasks = tasks_of(folder.string(), **manifest, options.channels);
  if (!tasks) return tl::unexpected(tasks.error());

  v1::Calibration out;
  out.set_version(kCalibrationVersion);
  out.set_fingerprint(recording::fingerprint(**manifest));
  out.set_started_ns((*manifest)->started_ns());
  out.set_made_ns(options.made_ns);
  *out.mutable_settings() = settings_of(options);
  const double across = options.array && devices_of(*tasks) > 1 ? 0.9 : 1.0;  // where these begin
  const auto count = static_cast<double>(tasks->size());
  for (std::size_t t = 0; t < tasks->size(); ++t) {
    const Task& task = (*tasks)[t];
    const Progress part = progress.part(across * static_cast<double>(t) / count,
                                        across * static_cast<double>(t + 1) / count);
    recording::ImportOptions import;
    import.channels = {task.channels.front().name};
    import.beside = true;
    const auto replicates = recording::import_recording(files, folder, import, part.part(0.0, 0.1));
    if (progress.stopped()) return fail("stopped");
    if (!replicates) {
      tell_unread(task, replicates.error(), out);
      continue;
    }
    calibrate_stream(task, *replicates, options, part.part(0.1, 1.0), out);
    if (progress.stopped()) return fail("stopped");
  }
  if (options.array) {
    for (v1::ArrayCalibration& one :
         arrays_across(files, folder, *tasks, options, progress.part(across, 1.0)))
      *out.add_arrays() = std::move(one);
    if (progress.stopped()) return fail("stopped");
  }
  out.set_summary(summary_of(out));
  return out;
}

std::vector<std::string> axes_without_unit(const std::vector<std::vector<Replicate>>& streams) {
  std::vector<std::string> out;
  for (const std::vector<Replicate>& replicates : streams) {
    for (const recording::Channel& one : replicates.front().channels) {
      const recording::Role role = recording::role_of(one.name);
      const bool axis = of_inertia(role.quantity) && role.axis != ' ';
      if (axis && one.unit.quantity == Quantity::kUnknown) out.push_back(one.name);
    }
  }
  return out;
}

Result<v1::Calibration> calibrate_files(const std::vector<std::vector<Replicate>>& streams,
                                        const CalibrateOptions& options, const Progress& progress) {
  if (auto readable = check_models(options); !readable) return tl::unexpected(readable.error());
  std::vector<Task> tasks;
  std::size_t channels = 0;
  for (const std::vector<Replicate>& replicates : streams) {
    Task& task = tasks.emplace_back();
    for (const recording::Channel& one : replicates.front().channels) {
      if (!options.channels.empty() || of_inertia(one.unit.quantity))
        task.channels.push_back({one.name, one.unit.symbol});
    }
    channels += task.channels.size();
  }
  if (channels == 0) {
    std::string names;
    for (const recording::Channel& one : streams.front().front().channels)
      names += (names.empty() ? "" : ", ") + one.name;
    return fail(fmt::format(
        "no channel is known to be an angular rate or an acceleration; give the unit of all, such "
        "as --unit deg/s, or of some, such as --unit 'NAME=deg/s', or name channels with --channel "
        "(it has: {})",
        names));
  }
  v1::Calibration out;
  out.set_version(kCalibrationVersion);
  out.set_made_ns(options.made_ns);
  *out.mutable_settings() = settings_of(options);
  const auto silent =
      options.channels.empty() ? axes_without_unit(streams) : std::vector<std::string>();
  for (const std::string& name : silent) {
    v1::ChannelCalibration& one = *out.add_channels();
    one.set_channel(name);
    add_trouble("unit", Error{"states no unit; give it, such as --unit 'gyro_*=deg/s,acc_*=g'"},
                *one.mutable_troubles());
  }
  double begin = 0.0;
  for (std::size_t s = 0; s < streams.size() && !progress.stopped(); ++s) {
    out.mutable_preflight()->MergeFrom(preflights(streams[s]));
    const double end =
        begin + static_cast<double>(tasks[s].channels.size()) / static_cast<double>(channels);
    calibrate_stream(tasks[s], streams[s], options, progress.part(begin, end), out);
    begin = end;
  }
  if (progress.stopped()) return fail("stopped");
  out.set_summary(summary_of(out));
  return out;
}

}  // namespace imunoise::study
