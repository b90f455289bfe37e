#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <future>
#include <iterator>
#include <stop_token>

#include "cli/commands/commands.h"
#include "cli/input.h"
#include "cli/interrupt.h"
#include "cli/output.h"
#include "cli/progress_line.h"
#include "recording/import/pieces.h"
#include "recording/import/table/file.h"
#include "study/calibration/calibrate.h"
#include "study/calibration/calibration_file.h"
#include "study/export/known_consumers.h"
#include "study/export/sha256.h"
#include "study/export/source.h"

namespace imunoise::cli {
namespace {

// Fits, and the bytes that they come from.
struct Fits {
  std::vector<study::SourceFit> fits;
  study::ExportSource source;
};

bool is_json(const std::filesystem::path& path) {
  const auto file = recording::File::open(path);
  if (!file) return false;
  std::array<char, 64> start{};
  const auto count = file->read_at(0, start);
  if (!count) return false;
  const std::string_view text(start.data(), *count);
  const std::size_t at = text.find_first_not_of(" \t\r\n");
  return at != std::string_view::npos && text[at] == '{';
}

// Ends early, without a hash, when it is told to stop.
Result<std::string> hash_of(const std::vector<std::filesystem::path>& paths,
                            const std::stop_token& stop = {}) {
  study::Sha256 hash;
  std::vector<char> block(std::size_t{1} << 20U);
  for (const std::filesystem::path& path : paths) {
    const auto file = recording::File::open(path);
    if (!file) return tl::unexpected(file.error());
    for (std::uint64_t at = 0; at < file->size() && !stop.stop_requested();) {
      const auto count = file->read_at(at, block);
      if (!count) return tl::unexpected(count.error());
      if (*count == 0) break;
      hash.add({block.data(), *count});
      at += *count;
    }
  }
  return hash.hex();
}

// A bag in a folder is its pieces.
std::vector<std::filesystem::path> with_pieces(const std::vector<std::filesystem::path>& files) {
  std::vector<std::filesystem::path> out;
  for (const std::filesystem::path& one : files) {
    const auto pieces = recording::pieces_of(one);
    out.insert(out.end(), pieces.begin(), pieces.end());
    if (pieces.empty()) out.push_back(one);
  }
  return out;
}

std::string names_of(const std::vector<std::filesystem::path>& files) {
  std::string out;
  for (const std::filesystem::path& one : files) {
    const auto name = one.has_filename() ? one.filename() : one.parent_path().filename();
    out += (out.empty() ? "" : ", ") + name.string();
  }
  return out;
}

study::CalibrateOptions calibrate_options(const ExportArguments& arguments) {
  study::CalibrateOptions out;
  out.models = arguments.models;
  out.channels = arguments.input.import.channels;
  out.explain = false;  // an export has only numbers
  out.diagnose = false;
  out.bootstrap.sets = 0;
  return out;
}

// Why no channel has a fit.
std::string why_none(const v1::Calibration& calibration) {
  for (const v1::ChannelCalibration& one : calibration.channels()) {
    if (!one.troubles().empty())
      return fmt::format("{}: {}", one.channel(), one.troubles(0).message());
  }
  return "no channel has a fit";
}

Result<Fits> fits_of_files(const ExportArguments& arguments) {
  const auto& files = arguments.input.files;
  const Interrupt interrupt;
  // A long file is hashed while it is read and fitted.
  std::stop_source enough;
  auto hashing = std::async(std::launch::async, hash_of, with_pieces(files), enough.get_token());
  const auto give_up = [&](const Error& error) {
    enough.request_stop();
    return tl::unexpected(error);
  };
  const auto streams = read_streams(arguments.input);
  if (!streams) return give_up(streams.error());
  // A file that lacks one of its sensors would look whole.
  if (const auto silent = study::axes_without_unit(*streams); !silent.empty())
    return give_up(Error{fmt::format(
        "{}: no unit is stated; give it, such as --unit 'gyro_*=deg/s,acc_*=g', or name other "
        "channels with --channel",
        fmt::join(silent, ", "))});
  const auto done = [&] {
    ProgressLine line("fitting");
    return study::calibrate_files(*streams, calibrate_options(arguments),
                                  line.progress(interrupt.token()));
  }();
  if (!done) return give_up(done.error());
  auto fits = study::fits_of(*done);
  if (fits.empty()) return give_up(Error{why_none(*done)});
  auto hash = hashing.get();
  if (!hash) return tl::unexpected(hash.error());
  return Fits{std::move(fits), {names_of(files), *hash}};
}

Result<Fits> fits_of_recording(const ExportArguments& arguments) {
  const std::filesystem::path& folder = arguments.input.files.front();
  recording::FileSystem& files = recording::posix_file_system();
  const auto known = study::read_calibration(files, folder);
  if (!known) return tl::unexpected(known.error());
  if (*known && arguments.models.empty()) {
    const auto hash = hash_of({folder / study::kCalibrationName});
    if (!hash) return tl::unexpected(hash.error());
    return Fits{study::fits_of(**known), {(folder / study::kCalibrationName).string(), *hash}};
  }
  const Interrupt interrupt;
  const auto done = [&] {
    ProgressLine line("fitting");
    return study::calibrate(files, folder, calibrate_options(arguments),
                            line.progress(interrupt.token()));
  }();
  if (!done) return tl::unexpected(done.error());
  return Fits{study::fits_of(*done), {folder.string(), done->fingerprint()}};
}

// What says how a recording is read has no effect on a result.
Result<void> check_for_results(const ExportArguments& arguments) {
  const recording::ImportOptions& how = arguments.input.import;
  const bool reads = how.rate || how.time_unit || how.from || how.until || !how.units.empty() ||
                     !how.exclude.empty() || how.use_disturbed || how.strict;
  if (!reads && arguments.models.empty()) return {};
  return fail(fmt::format(
      "{} is a result of imunoise: --model, --rate, --unit and what else says how a recording is "
      "read are for recordings",
      names_of(arguments.input.files)));
}

// Several files: gyroscope and accelerometer were fitted one after the other.
Result<Fits> fits_of_json(const std::vector<std::filesystem::path>& paths) {
  Fits out;
  std::string all;
  for (const std::filesystem::path& path : paths) {
    const auto text = recording::posix_file_system().read(path);
    if (!text) return tl::unexpected(text.error());
    auto fits = study::parse_fits(*text);
    if (!fits) return fail(path.string() + ": " + fits.error().message);
    std::move(fits->begin(), fits->end(), std::back_inserter(out.fits));
    all += *text;
  }
  out.source = {names_of(paths), study::sha256(all)};
  return out;
}

Result<Fits> read_fits(const ExportArguments& arguments) {
  const auto& files = arguments.input.files;
  if (is_recording(arguments.input)) return fits_of_recording(arguments);
  const auto json = std::count_if(files.begin(), files.end(), is_json);
  if (json == static_cast<std::ptrdiff_t>(files.size())) {
    if (auto checked = check_for_results(arguments); !checked)
      return tl::unexpected(checked.error());
    return fits_of_json(files);
  }
  if (json > 0)
    return fail(
        "some of these files are results of imunoise and some are recordings; export one "
        "kind at a time");
  return fits_of_files(arguments);
}

// Of an array; nothing where the files are not its JSON.
std::optional<Result<std::string>> array_text(const ExportArguments& arguments) {
  const std::filesystem::path& path = arguments.input.files.front();
  if (arguments.input.files.size() > 1 || !is_json(path)) return std::nullopt;
  const auto text = recording::posix_file_system().read(path);
  if (!text) return std::nullopt;
  const auto report = study::parse_array(*text);
  if (!report) return std::nullopt;
  return study::export_array(*report, *study::consumer_called(arguments.to),
                             {path.filename().string(), study::sha256(*text)});
}

Result<std::string> export_text(const ExportArguments& arguments) {
  if (auto array = array_text(arguments)) return std::move(*array);
  const auto fits = read_fits(arguments);
  if (!fits) return tl::unexpected(fits.error());
  const auto chosen =
      study::chosen_fits(fits->fits, arguments.device, arguments.input.import.channels);
  if (!chosen) return tl::unexpected(chosen.error());
  const auto imu = study::imu_noise(*chosen);
  if (!imu) return tl::unexpected(imu.error());
  return study::export_noise(*imu, *study::consumer_called(arguments.to), fits->source,
                             arguments.options);
}

}  // namespace

int run(const ExportArguments& arguments) {
  const auto text = export_text(arguments);
  if (!text) return print_error(text.error());
  if (!arguments.out) {
    print(*text);
    return 0;
  }
  if (auto done = write_file(*arguments.out, *text); !done) return print_error(done.error());
  tell(fmt::format("wrote {}\n", arguments.out->string()));
  return 0;
}

}  // namespace imunoise::cli
