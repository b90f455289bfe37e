#include "daemon/catalogue/fleet.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "daemon/catalogue/parameter_names.h"

namespace imunoise::catalogue {
namespace {

constexpr double kOfMedianDeviation = 1.4826;  // standard deviations of a normal distribution

// At a fraction of the way through sorted values, between neighbours.
double quantile(const std::vector<double>& sorted, double fraction) {
  const double at = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return quantile(values, 0.5);
}

void compare(v1::FleetParameter& parameter) {
  std::vector<double> logs;
  for (const v1::FleetDevice& one : parameter.devices()) {
    if (is_seen(one.newest())) logs.push_back(std::log(one.newest().value()));
  }
  parameter.set_seen(static_cast<std::uint32_t>(logs.size()));
  if (logs.empty()) return;
  std::sort(logs.begin(), logs.end());
  const double median = quantile(logs, 0.5);
  parameter.set_median(std::exp(median));
  parameter.set_lower_quartile(std::exp(quantile(logs, 0.25)));
  parameter.set_upper_quartile(std::exp(quantile(logs, 0.75)));
  std::vector<double> distances;
  for (const double one : logs) distances.push_back(std::abs(one - median));
  const double spread = kOfMedianDeviation * median_of(std::move(distances));
  if (parameter.seen() < kLeastFleet || !(spread > 0.0)) return;
  for (v1::FleetDevice& one : *parameter.mutable_devices()) {
    const v1::HistoryPoint& newest = one.newest();
    if (!is_seen(newest)) continue;
    one.set_robust_z((std::log(newest.value()) - median) / spread);
    const bool apart =
        newest.upper() < parameter.lower_quartile() || newest.lower() > parameter.upper_quartile();
    one.set_outlier(apart && std::abs(one.robust_z()) > kOutlierReach);
  }
}

using Name = std::tuple<std::string, std::string, std::string, std::string>;

void describe(const v1::ParameterHistory& from, v1::FleetParameter& to) {
  to.set_stream(from.stream());
  to.set_channel(from.channel());
  to.set_term(from.term());
  to.set_parameter(from.parameter());
  to.set_title(from.title());
  to.set_unit(from.unit());
  to.set_datasheet_unit(from.datasheet_unit());
  to.set_to_datasheet(from.to_datasheet());
}

std::string fleet_summary(const v1::Fleet& fleet) {
  std::string outliers;
  bool compared = false;
  for (const v1::FleetParameter& parameter : fleet.parameters()) {
    compared = compared || parameter.seen() >= kLeastFleet;
    for (const v1::FleetDevice& one : parameter.devices()) {
      if (!one.outlier()) continue;
      outliers += fmt::format("{}{} ({} {} of {})", outliers.empty() ? "" : ", ", one.device().id(),
                              parameter.channel(), parameter.parameter(), parameter.term());
    }
  }
  if (!outliers.empty()) return "These stand out: " + outliers + ".";
  if (compared) return fmt::format("None of {} devices stands out.", fleet.devices());
  return fmt::format(
      "Too few devices to say whether one stands out: that takes {} of them, each "
      "with an interval.",
      kLeastFleet);
}

bool is_wanted(const v1::ParameterHistory& one, const FleetOptions& options) {
  const auto has = [](const std::vector<std::string>& all, const auto& is) {
    return all.empty() || std::any_of(all.begin(), all.end(), is);
  };
  return has(options.channels, [&](const auto& name) { return name == one.channel(); }) &&
         has(options.parameters, [&](const auto& name) { return is_called(one, name); });
}

void add_notes(v1::Fleet& fleet) {
  std::set<std::string> models;
  for (const v1::FleetParameter& parameter : fleet.parameters()) {
    for (const v1::FleetDevice& one : parameter.devices()) models.insert(one.newest().model());
  }
  if (models.size() < 2) return;
  fleet.add_notes(fmt::format(
      "The newest calibrations have different models ({}); calibrate with one --model to compare "
      "like with like.",
      fmt::join(models, ", ")));
}

}  // namespace

Result<v1::Fleet> fleet_of(const std::vector<DeviceParameters>& devices,
                           const FleetOptions& options) {
  std::set<std::string> types;
  for (const auto& [device, parameters] : devices) {
    if (!parameters.empty()) types.insert(device.driver());
  }
  if (types.empty())
    return fail("no calibration of any device has a model yet (imunoise calibrate)");
  if (!options.type.empty() && !types.contains(options.type))
    return fail(fmt::format("type '{}': no device of it is calibrated; there are {}", options.type,
                            fmt::join(types, ", ")));
  v1::Fleet out;
  out.set_type(options.type.empty() ? *types.begin() : options.type);
  *out.mutable_types() = {types.begin(), types.end()};
  std::map<Name, v1::FleetParameter> found;
  for (const auto& [device, parameters] : devices) {
    if (parameters.empty() || device.driver() != out.type()) continue;
    out.set_devices(out.devices() + 1);
    for (const v1::ParameterHistory& one : parameters) {
      if (!is_wanted(one, options)) continue;
      v1::FleetParameter& to = found[{one.stream(), one.channel(), one.term(), one.parameter()}];
      describe(one, to);
      v1::FleetDevice& row = *to.add_devices();
      *row.mutable_device() = device;
      *row.mutable_newest() = *one.points().rbegin();
      row.set_calibrations(static_cast<std::uint32_t>(one.points_size()));
    }
  }
  if (found.empty()) return fail("no calibration of these devices has such a channel or parameter");
  for (auto& [name, parameter] : found) {
    std::stable_sort(parameter.mutable_devices()->begin(), parameter.mutable_devices()->end(),
                     [](const v1::FleetDevice& a, const v1::FleetDevice& b) {
                       return a.newest().value() < b.newest().value();
                     });
    compare(parameter);
    *out.add_parameters() = std::move(parameter);
  }
  out.set_summary(fleet_summary(out));
  add_notes(out);
  return out;
}

}  // namespace imunoise::catalogue
