#include "cli/input.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "cli/progress_line.h"
#include "core/support/counted.h"
#include "recording/import/pieces.h"
#include "recording/import/table/names.h"
#include "recording/store/reading/across.h"
#include "recording/store/reading/places.h"
#include "recording/store/reading/replicates.h"
#include "study/analysis/less_effects.h"

namespace imunoise::cli {

bool is_recording(const InputArguments& arguments) {
  const std::filesystem::path& first = arguments.files.front();
  return arguments.files.size() == 1 && std::filesystem::is_directory(first) &&
         recording::pieces_of(first).empty();
}

namespace {

// Whether the channels lie in several devices. Files that cannot be read are reported elsewhere.
bool several_devices(const InputArguments& arguments) {
  if (!is_recording(arguments)) return false;
  const std::filesystem::path& root = arguments.files.front();
  const auto manifest = recording::manifest_of(recording::posix_file_system(), root);
  if (!manifest) return false;
  const auto wanted = recording::wanted_of(root.string(), recording::offers_of(*manifest),
                                           arguments.import.channels);
  return wanted && std::any_of(wanted->begin(), wanted->end(), [&](const recording::Wanted& one) {
           return one.place.device != wanted->front().place.device;
         });
}

void tell(const recording::JoinedStream& one) {
  fmt::print(stderr, "joined: {}/{}, {:.6g} Hz, clock {:+.1f} ppm, {} left out{}\n", one.device,
             one.stream, one.rate.value, one.clock_ppm, counted(one.dropped, "sample"),
             one.averaged > 1 ? fmt::format(", means of {}", one.averaged) : "");
}

Result<std::vector<recording::Replicate>> joined(const InputArguments& arguments) {
  const recording::ImportOptions& options = arguments.import;
  if (options.rate || !options.units.empty() || options.split_into > 1)
    return fail(
        "channels of several devices keep their own rates and units, and their replicates: "
        "--rate, --unit and --split-into are for those of one");
  ProgressLine line("reading");
  auto groups = recording::import_across(recording::posix_file_system(), arguments.files.front(),
                                         options.channels, line.progress());
  if (!groups) return tl::unexpected(groups.error());
  recording::Across& all = groups->front();
  if (!all.left_out.empty()) {
    const recording::LeftOut& one = all.left_out.front();
    return fail(fmt::format("{}/{}: {}", one.device, one.stream, one.reason));
  }
  for (const recording::JoinedStream& one : all.streams) tell(one);
  return std::move(all.replicates);
}

// A sentence, and the files that it is about.
struct Said {
  std::string text;
  std::string first;
  std::string last;
  std::size_t files = 1;
};

void say(std::string text, const std::string& file, std::vector<Said>& all) {
  const auto same =
      std::find_if(all.begin(), all.end(), [&](const Said& one) { return one.text == text; });
  if (same == all.end()) {
    all.push_back({std::move(text), file, file});
  } else if (same->last != file) {
    ++same->files;
    same->last = file;
  }
}

std::string files_of(const Said& one) {
  if (one.files == 1) return one.first;
  return fmt::format("{} and {} more file{}", one.first, one.files - 1, one.files > 2 ? "s" : "");
}

// What was recognised, and every finding, before anything is computed. What holds for many files
// is said once.
void tell_preflight(const std::vector<recording::Replicate>& replicates) {
  const recording::Preflight* before = nullptr;
  std::vector<Said> all;
  for (const recording::Replicate& one : replicates) {
    const recording::Preflight* const found = one.preflight.get();
    if (found == nullptr || found == before) continue;
    before = found;
    for (const std::string& said : found->recognised) say(said, found->file, all);
    for (const recording::Finding& finding : found->findings) say(finding.text, found->file, all);
    if (found->used < found->samples)
      say(fmt::format("{} of {} used, in {}", found->used, counted(found->samples, "sample"),
                      counted(found->stretches, "stretch")),
          found->file, all);
  }
  for (const Said& one : all) fmt::print(stderr, "{}: {}\n", files_of(one), printable(one.text));
}

}  // namespace

Result<std::vector<recording::Replicate>> read_together(const InputArguments& arguments) {
  return several_devices(arguments) ? joined(arguments) : read_input(arguments);
}

Result<std::vector<recording::Replicate>> read_with_witnesses(
    InputArguments arguments, const std::vector<std::string>& witnesses) {
  arguments.import.beside = true;
  // Without a name the channel under study is among what stands beside.
  if (!arguments.import.channels.empty()) arguments.import.witnesses = witnesses;
  return read_input(arguments);
}

Result<void> check_for_recording(const recording::ImportOptions& options) {
  if (options.time_unit || options.from || options.until || !options.exclude.empty() ||
      options.use_disturbed || options.strict || !options.units.empty())
    return fail(
        "--unit, --time-unit, --from, --until, --exclude and --strict are for files, not for "
        "folders of recordings; leave them out");
  if (!options.topic.empty() || !options.dbc.empty() || options.delimiter || options.header)
    return fail(
        "--topic, --dbc, --delimiter and --header are for files, not for folders of recordings; "
        "leave them out");
  return {};
}

Result<std::vector<recording::Replicate>> read_input(const InputArguments& arguments) {
  if (is_recording(arguments)) {
    if (auto whole = check_for_recording(arguments.import); !whole)
      return tl::unexpected(whole.error());
    ProgressLine line("reading");
    return recording::import_recording(recording::posix_file_system(), arguments.files.front(),
                                       arguments.import, line.progress());
  }
  auto replicates = read_again(arguments);
  if (replicates) tell_preflight(*replicates);
  return replicates;
}

Result<std::vector<recording::Replicate>> read_again(const InputArguments& arguments) {
  ProgressLine line("reading");
  return recording::import_files(arguments.files, arguments.import, line.progress());
}

Result<std::vector<std::vector<recording::Replicate>>> read_streams(
    const InputArguments& arguments) {
  std::vector<std::vector<recording::Replicate>> out;
  auto first = read_input(arguments);
  if (!first) return tl::unexpected(first.error());
  const auto preflight = first->front().preflight;
  out.push_back(std::move(*first));
  const bool chosen = !arguments.import.topic.empty() || !arguments.import.channels.empty();
  if (chosen || preflight == nullptr) return out;
  for (const recording::OtherStream& one : preflight->others) {
    InputArguments alone = arguments;
    if (one.is_topic) {
      alone.import.topic = one.name;
    } else {
      alone.import.channels = recording::split_names(one.name);
    }
    auto read = read_input(alone);
    if (!read) return tl::unexpected(read.error());
    out.push_back(std::move(*read));
  }
  return out;
}

Result<Subjects> read_subjects(const InputArguments& arguments,
                               const std::vector<std::string>& models) {
  const auto witnesses = study::witnesses_of(models);
  if (!witnesses) return tl::unexpected(witnesses.error());
  auto replicates =
      witnesses->empty() ? read_input(arguments) : read_with_witnesses(arguments, *witnesses);
  if (!replicates) return tl::unexpected(replicates.error());
  Subjects out{std::move(*replicates), {}};
  const std::vector<std::string>& named = arguments.import.channels;
  const auto contains = [](const std::vector<std::string>& names, const std::string& one) {
    return std::find(names.begin(), names.end(), one) != names.end();
  };
  const std::vector<recording::Channel>& read = out.replicates.front().channels;
  for (std::size_t c = 0; c < read.size(); ++c) {
    const bool subject = named.empty()
                             ? !read[c].interpolated && !contains(*witnesses, read[c].name)
                             : std::any_of(named.begin(), named.end(), [&](const auto& name) {
                                 return recording::matches(name, read[c].name);
                               });
    if (subject) out.series.push_back(study::series_of(out.replicates, c));
  }
  if (out.series.empty())
    return fail(
        "every channel of the files is a witness of the model; name the channel to analyse "
        "with --channel");
  return out;
}

std::vector<study::Series> all_series(const std::vector<recording::Replicate>& replicates) {
  std::vector<study::Series> out;
  for (std::size_t i = 0; i < replicates.front().channels.size(); ++i) {
    out.push_back(study::series_of(replicates, i));
  }
  return out;
}

}  // namespace imunoise::cli
