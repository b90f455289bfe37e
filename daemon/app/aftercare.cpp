#include "daemon/app/aftercare.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "daemon/catalogue/history.h"
#include "daemon/catalogue/scan.h"
#include "daemon/process/program.h"
#include "recording/store/manifest/manifest.h"
#include "study/calibration/calibration_file.h"

namespace imunoise::app {
namespace {

std::vector<std::string> command_of(const std::filesystem::path& imunoise,
                                    const std::filesystem::path& recording,
                                    const v1::CampaignCalibration& how) {
  std::vector<std::string> out = {imunoise.string(), "calibrate", recording.string()};
  for (const std::string& model : how.models()) out.insert(out.end(), {"--model", model});
  if (!how.diagnose()) out.emplace_back("--no-diagnose");
  if (how.array()) out.emplace_back("--array");
  if (!how.array_model().empty()) out.insert(out.end(), {"--array-model", how.array_model()});
  return out;
}

// A calibration of just this recording, made as the campaign asks.
bool is_current(const v1::Calibration& made, const v1::Manifest& manifest,
                const v1::CampaignCalibration& how) {
  const v1::CalibrationSettings& settings = made.settings();
  return made.fingerprint() == recording::fingerprint(manifest) &&
         std::equal(settings.models().begin(), settings.models().end(), how.models().begin(),
                    how.models().end()) &&
         settings.diagnose() == how.diagnose() && settings.array() == how.array() &&
         settings.array_model() == how.array_model();
}

Result<v1::Manifest> manifest_of(const recording::FileSystem& files,
                                 const std::filesystem::path& recording) {
  auto manifest = recording::read_manifest(files, recording);
  if (!manifest) return tl::make_unexpected(manifest.error());
  if (!*manifest) return fail(recording.string() + ": has no manifest");
  return std::move(**manifest);
}

// What the history says of each device that drifts.
Result<std::string> drifts(catalogue::Catalogue& catalogue, const v1::Manifest& manifest,
                           const Progress& progress) {
  std::string out;
  for (const v1::RecordedDevice& recorded : manifest.devices()) {
    progress.report(1.0);
    const auto device = catalogue.device(catalogue::device_id(recorded));
    if (!device) return tl::make_unexpected(device.error());
    auto parameters = catalogue.parameters(device->id());
    if (!parameters) return tl::make_unexpected(parameters.error());
    if (parameters->empty()) continue;
    const auto history = catalogue::history_of(*device, std::move(*parameters));
    if (!history) return tl::make_unexpected(history.error());
    if (!history->alarm()) continue;
    out += fmt::format("{}{} drifts: {}", out.empty() ? "" : "; ", recorded.name(),
                       history->summary());
  }
  return out;
}

}  // namespace

Result<std::string> Aftercare::calibrate(const v1::Campaign& campaign,
                                         const std::filesystem::path& recording,
                                         const Progress& progress) {
  const v1::CampaignCalibration& how = campaign.calibration();
  const std::lock_guard lock(calibrating_);
  const auto manifest = manifest_of(files_, recording);
  if (!manifest) return tl::make_unexpected(manifest.error());
  const auto before = study::read_calibration(files_, recording);
  if (before && *before && is_current(**before, *manifest, how)) return "";
  recording::DiskCalls::Watch watch(calls_, "calibration", recording);
  const process::Talk talk{.works = [&] { watch.progress(); }};
  const auto done = process::run_program(command_of(imunoise_, recording, how), progress, talk);
  if (!done) return tl::make_unexpected(done.error());
  const auto made = study::read_calibration(files_, recording);
  if (!made) return tl::make_unexpected(made.error());
  if (!*made) return fail(recording.string() + ": imunoise calibrate ended without a result");
  return (*made)->summary();
}

Result<std::string> Aftercare::publish(const v1::Campaign& campaign,
                                       const std::filesystem::path& recording,
                                       const Progress& progress) {
  const std::lock_guard lock(publishing_);
  const auto manifest = manifest_of(files_, recording);
  if (!manifest) return tl::make_unexpected(manifest.error());
  recording::DiskCalls::Watch watch(calls_, "update of the catalogue", campaign.folder());
  const Progress watched(
      [&](double fraction) {
        watch.progress();
        progress.report(fraction);
      },
      progress.stop_token());
  auto catalogue = catalogue::Catalogue::open(catalogue::place_in(campaign.folder()));
  if (!catalogue) return tl::make_unexpected(catalogue.error());
  const auto changes = catalogue->refresh(files_, campaign.folder(), watched);
  if (!changes) return tl::make_unexpected(changes.error());
  const std::string& repair = catalogue->repair();
  if (*changes == catalogue::Changes{0, changes->unchanged, 0}) return repair;
  const auto drift = drifts(*catalogue, *manifest, watched);
  if (!drift || repair.empty()) return drift;
  return drift->empty() ? repair : repair + "; " + *drift;
}

}  // namespace imunoise::app
