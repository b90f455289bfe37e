#include "daemon/service/recordings/records.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "daemon/catalogue/fleet.h"
#include "daemon/catalogue/history.h"
#include "daemon/service/api/figure_answer.h"
#include "daemon/service/recordings/confined_files.h"
#include "recording/store/manifest/manifest.h"
#include "study/calibration/calibration_file.h"
#include "study/report/figures/cross_figure.h"
#include "study/report/figures/fleet_figure.h"
#include "study/report/figures/history_figure.h"
#include "study/report/figures/virtual_sensor_figures.h"

namespace imunoise::service {
namespace {

namespace fs = std::filesystem;

// Nothing in it leads anywhere but down.
bool leads_down(const std::string& folder) {
  const fs::path path(folder);
  return !path.empty() && path.is_relative() && folder.find_first_of("\\") == std::string::npos &&
         folder.find('\0') == std::string::npos &&
         std::none_of(path.begin(), path.end(), [](const fs::path& part) {
           return part.empty() || part == "." || part == "..";
         });
}

// Keeps those of one campaign; empty: all.
template <class Entries>
void keep(Entries& entries, const std::string& campaign) {
  if (campaign.empty()) return;
  entries.erase(std::remove_if(entries.begin(), entries.end(),
                               [&](const auto& one) { return one.bench() != campaign; }),
                entries.end());
}

std::vector<fs::path> folders_in(const std::map<std::string, fs::path>& roots) {
  std::vector<fs::path> out;
  for (const auto& [campaign, root] : roots) out.push_back(root);
  return out;
}

}  // namespace

Result<std::unique_ptr<Records>> Records::open(Campaigns campaigns,
                                               std::chrono::milliseconds freshness,
                                               recording::DiskCalls& calls,
                                               std::uint64_t largest_shown) {
  auto catalogue = catalogue::Catalogue::open(":memory:");
  if (!catalogue) return tl::unexpected(catalogue.error());
  return std::unique_ptr<Records>(
      new Records(std::move(campaigns), std::move(*catalogue), freshness, calls, largest_shown));
}

Records::View::View(Roots of, recording::DiskCalls& calls)
    : roots(std::move(of)), confined(confined_files(folders_in(roots))), files(*confined, calls) {}

std::shared_ptr<Records::View> Records::view() const {
  Roots roots;
  for (const v1::Campaign& one : campaigns_()) {
    roots[one.name()] = fs::absolute(one.folder()).lexically_normal();
  }
  const std::lock_guard lock(viewing_);
  if (!view_ || view_->roots != roots) view_ = std::make_shared<View>(std::move(roots), calls_);
  return view_;
}

std::vector<fs::path> Records::folders() const { return folders_in(view()->roots); }

Answer<void> Records::check_campaign(const std::string& campaign) const {
  if (campaign.empty() || view()->roots.contains(campaign)) return {};
  return refuse(404, fmt::format("there is no campaign '{}'", campaign));
}

// The roots themselves lie outside of what their files show.
bool Records::is_there(const fs::path& root) const {
  const recording::DiskCalls::Watch watch(calls_, "stat", root);
  std::error_code unknown;
  return fs::exists(root, unknown);
}

Answer<void> Records::refresh() {
  const auto now = std::chrono::steady_clock::now();
  const auto current = view();
  if (catalogued_ != current) {  // begun anew: it would keep what campaigns had that are gone
    auto empty = catalogue::Catalogue::open(":memory:");
    if (!empty) return refuse(500, empty.error().message);
    catalogue_ = std::move(*empty);
    catalogued_ = current;
    refreshed_.reset();
  }
  if (refreshed_ && now - *refreshed_ < freshness_) return {};
  for (const auto& [campaign, root] : current->roots) {
    if (!is_there(root)) continue;  // nothing was recorded yet
    catalogue_.use_bench(campaign);
    if (const auto done = catalogue_.refresh(current->files, root); !done)
      return refuse(500, done.error().message);
  }
  refreshed_ = std::chrono::steady_clock::now();
  return {};
}

Answer<v1::RecordingList> Records::recordings(const std::string& campaign) {
  if (auto known = check_campaign(campaign); !known) return tl::unexpected(known.error());
  const std::lock_guard lock(mutex_);
  if (auto done = refresh(); !done) return tl::unexpected(done.error());
  auto out = catalogue_.recordings();
  if (!out) return refuse(500, out.error().message);
  keep(*out->mutable_recordings(), campaign);
  return std::move(*out);
}

Answer<v1::CalibrationList> Records::calibrations(const std::string& campaign) {
  if (auto known = check_campaign(campaign); !known) return tl::unexpected(known.error());
  const std::lock_guard lock(mutex_);
  if (auto done = refresh(); !done) return tl::unexpected(done.error());
  auto out = catalogue_.calibrations();
  if (!out) return refuse(500, out.error().message);
  keep(*out->mutable_calibrations(), campaign);
  return std::move(*out);
}

Answer<v1::ArrayList> Records::arrays(const std::string& campaign) {
  const auto all = calibrations(campaign);
  if (!all) return tl::unexpected(all.error());
  v1::ArrayList out;
  for (const v1::CataloguedCalibration& one : all->calibrations()) {
    const auto read = calibration(one.bench(), one.folder());
    if (!read) continue;  // the list of calibrations says why
    for (const v1::ArrayCalibration& array : read->arrays()) {
      v1::CataloguedArray& to = *out.add_arrays();
      to.set_bench(one.bench());
      to.set_folder(one.folder());
      to.set_started_ns(one.started_ns());
      to.set_device(array.device());
      to.set_stream(array.stream());
      *to.mutable_channels() = array.channels();
    }
  }
  return out;
}

Answer<v1::History> Records::history(const v1::GetHistoryRequest& request) {
  if (request.device().empty())
    return refuse(400, "name a device: ?device=, its serial number or its name");
  catalogue::HistoryOptions options;
  options.channels.assign(request.channel().begin(), request.channel().end());
  options.parameters.assign(request.parameter().begin(), request.parameter().end());
  if (request.has_level()) options.level = request.level();
  if (options.level < 1e-9 || options.level > 0.5)
    return refuse(400, "level: a probability from 1e-9 to 0.5");
  const std::lock_guard lock(mutex_);
  if (auto done = refresh(); !done) return tl::unexpected(done.error());
  const auto device = catalogue_.device(request.device());
  if (!device) return refuse(404, device.error().message);
  auto parameters = catalogue_.parameters(device->id());
  if (!parameters) return refuse(500, parameters.error().message);
  auto out = catalogue::history_of(*device, std::move(*parameters), options);
  if (!out) return refuse(404, out.error().message);
  return std::move(*out);
}

Answer<v1::Text> Records::history_figure(const v1::GetHistoryFigureRequest& request) {
  if (auto good = check_figure_size(request.width(), request.height()); !good)
    return tl::unexpected(good.error());
  v1::GetHistoryRequest all;
  all.set_device(request.device());
  const auto known = history(all);
  if (!known) return tl::unexpected(known.error());
  const auto found = std::find_if(
      known->parameters().begin(), known->parameters().end(), [&](const v1::ParameterHistory& one) {
        return one.stream() == request.stream() && one.channel() == request.channel() &&
               one.term() == request.term() && one.parameter() == request.parameter();
      });
  if (found == known->parameters().end())
    return refuse(404, "stream, channel, term and parameter: name one as /v1/history lists it");
  const auto figure = report::history_figure(*found);
  if (!figure) return refuse(404, "this parameter was calibrated once; record the device again");
  return figure_answer(*figure, request);
}

Answer<v1::Fleet> Records::fleet(const v1::GetFleetRequest& request) {
  const std::lock_guard lock(mutex_);
  if (auto done = refresh(); !done) return tl::unexpected(done.error());
  auto devices = catalogue_.devices();
  if (!devices) return refuse(500, devices.error().message);
  std::vector<catalogue::DeviceParameters> all;
  for (v1::CataloguedDevice& one : *devices) {
    auto parameters = catalogue_.parameters(one.id());
    if (!parameters) return refuse(500, parameters.error().message);
    all.emplace_back(std::move(one), std::move(*parameters));
  }
  auto out = catalogue::fleet_of(
      all, {.type = request.type(),
            .channels = {request.channel().begin(), request.channel().end()},
            .parameters = {request.parameter().begin(), request.parameter().end()}});
  if (!out) return refuse(404, out.error().message);
  return std::move(*out);
}

Answer<v1::Text> Records::fleet_figure(const v1::GetFleetFigureRequest& request) {
  if (auto good = check_figure_size(request.width(), request.height()); !good)
    return tl::unexpected(good.error());
  v1::GetFleetRequest wanted;
  wanted.set_type(request.type());
  const auto known = fleet(wanted);
  if (!known) return tl::unexpected(known.error());
  const auto found = std::find_if(
      known->parameters().begin(), known->parameters().end(), [&](const v1::FleetParameter& one) {
        return one.stream() == request.stream() && one.channel() == request.channel() &&
               one.term() == request.term() && one.parameter() == request.parameter();
      });
  if (found == known->parameters().end())
    return refuse(404, "stream, channel, term and parameter: name one as /v1/fleet lists it");
  const auto figure = report::fleet_figure(*found);
  if (!figure) return refuse(404, "no device has a value above zero");
  return figure_answer(*figure, request);
}

Answer<v1::Text> Records::array_figure(const v1::GetArrayFigureRequest& request) const {
  if (auto good = check_figure_size(request.width(), request.height()); !good)
    return tl::unexpected(good.error());
  const auto known = calibration(request.campaign(), request.folder());
  if (!known) return tl::unexpected(known.error());
  if (request.array() >= static_cast<std::uint32_t>(known->arrays_size()))
    return refuse(404, fmt::format("array {}: the recording has {}, counted from 0",
                                   request.array(), known->arrays_size()));
  const v1::ArrayReport& report = known->arrays(static_cast<int>(request.array())).report();
  const v1::VirtualSensor* sensor = &report.virtual_sensor();
  if (request.has_emphasis()) {
    if (request.emphasis() >= static_cast<std::uint32_t>(report.trade_offs_size()))
      return refuse(404, fmt::format("emphasis: the array has {} trade-offs, counted from 0",
                                     report.trade_offs_size()));
    sensor = &report.trade_offs(static_cast<int>(request.emphasis()));
  }
  std::optional<figure::Figure> figure;
  if (request.view() == "covariances") {
    figure = report::cross_figure(report);
  } else if (request.view() == "correlations") {
    figure = report::correlations_figure(report);
  } else if (request.view() == "gain") {
    figure = report::gain_figure(*sensor);
  } else if (request.view() == "weights") {
    figure = report::weights_figure(*sensor);
  } else {
    return refuse(400, "view: covariances, correlations, gain or weights");
  }
  if (!figure) return refuse(404, "this array has nothing to show here");
  return figure_answer(*figure, request);
}

Answer<v1::SampleRanges> Records::samples(const v1::GetSamplesRequest& request) {
  const auto known = manifest(request.campaign(), request.folder());
  if (!known) return tl::unexpected(known.error());
  const auto path = path_of(request.campaign(), request.folder());
  if (!path) return tl::unexpected(path.error());
  return samples_.ranges(view()->files, *path, *known, request);
}

Answer<std::string> Records::calibration_text(const std::string& campaign,
                                              const std::string& folder) const {
  const auto path = path_of(campaign, folder);
  if (!path) return tl::unexpected(path.error());
  auto out = view()->files.read(*path / study::kCalibrationName);
  if (!out) return refuse(500, out.error().message);
  return std::move(*out);
}

Answer<fs::path> Records::path_of(const std::string& campaign, const std::string& folder) const {
  const auto current = view();
  const auto root = current->roots.find(campaign);
  if (root == current->roots.end())
    return refuse(404, fmt::format("there is no campaign '{}'", campaign));
  if (!leads_down(folder))
    return refuse(400, "folder: name a recording as /v1/recordings lists it");
  const fs::path path = root->second / folder;
  if (const auto names = current->files.list(path); !names)
    return refuse(404, fmt::format("campaign '{}' has no recording '{}'", campaign, folder));
  return path;
}

Answer<v1::Manifest> Records::manifest(const std::string& campaign,
                                       const std::string& folder) const {
  const auto path = path_of(campaign, folder);
  if (!path) return tl::unexpected(path.error());
  auto out = recording::read_manifest(view()->files, *path);
  if (!out) return refuse(500, out.error().message);
  if (!*out)
    return refuse(404, fmt::format("campaign '{}' has no recording '{}'", campaign, folder));
  return std::move(**out);
}

Answer<v1::Calibration> Records::calibration(const std::string& campaign,
                                             const std::string& folder) const {
  const auto path = path_of(campaign, folder);
  if (!path) return tl::unexpected(path.error());
  auto out = study::read_calibration(view()->files, *path);
  if (!out) return refuse(500, out.error().message);
  if (!*out)
    return refuse(
        404, fmt::format("recording '{}' is not calibrated; imunoise calibrate does it", folder));
  return std::move(**out);
}

}  // namespace imunoise::service
