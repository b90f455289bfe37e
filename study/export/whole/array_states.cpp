#include "study/export/whole/array_states.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "study/analysis/arrays/array_parameters.h"

namespace imunoise::study {
namespace {

using Index = Eigen::Index;

Index sensor_index(const v1::ArrayReport& report, const std::string& name) {
  const auto found = std::find(report.sensors().begin(), report.sensors().end(), name);
  return found == report.sensors().end() ? -1
                                         : static_cast<Index>(found - report.sensors().begin());
}

std::vector<Index> sensors_of(const v1::ArrayReport& report, const v1::ArrayParameter& parameter) {
  std::vector<Index> out;
  for (const std::string& one : parameter.sensors()) out.push_back(sensor_index(report, one));
  return out;
}

// Sensors that share a process of a group are one group.
ArrayLayout layout_of(const v1::ArrayReport& report) {
  ArrayLayout out{static_cast<std::size_t>(report.sensors_size())};
  std::vector<std::size_t> group(out.sensors, 0);
  std::set<std::vector<Index>> groups;
  for (const v1::ArrayParameter& one : report.parameters())
    if (one.term().ends_with("[group]")) groups.insert(sensors_of(report, one));
  std::size_t number = 0;
  for (const std::vector<Index>& one : groups) {
    for (const Index s : one)
      if (s >= 0) group[static_cast<std::size_t>(s)] = number;
    ++number;
  }
  if (!groups.empty()) out.group = group;
  return out;
}

bool set_parameter(const std::vector<Index>& sensors, const v1::ArrayParameter& from, Latent& to) {
  const std::vector<ParameterInfo> about = parameters(to.term.process);
  const auto found = std::find_if(about.begin(), about.end(), [&](const ParameterInfo& one) {
    return one.name == from.parameter();
  });
  if (found == about.end()) return false;
  const auto number = static_cast<std::size_t>(found - about.begin());
  if (number == 0 && to.matrix()) {
    to.power(sensors.front(), sensors.back()) = from.value();
    to.power(sensors.back(), sensors.front()) = from.value();
    return true;
  }
  if (sensors != to.sensors) return false;
  if (number == 0) {
    to.set_scalar(from.value());
  } else {
    std::vector<double> all = values(to.term.process);
    all[number] = from.value();
    set_values(to.term.process, all);
  }
  return true;
}

}  // namespace

Result<ArrayModel> array_model(const v1::ArrayReport& report) {
  const auto written = parse_array_model(report.model(), Hertz{report.rate_hz()});
  if (!written) return tl::unexpected(written.error());
  ArrayModel out = expand(*written, layout_of(report));
  for (const v1::ArrayParameter& from : report.parameters()) {
    const std::vector<Index> sensors = sensors_of(report, from);
    bool done = false;
    if (!sensors.empty() && *std::min_element(sensors.begin(), sensors.end()) >= 0) {
      for (Latent& latent : out.latents) {
        done = done || (array_label(*written, latent.written) == from.term() &&
                        set_parameter(sensors, from, latent));
      }
    }
    if (!done)
      return fail(fmt::format("the model {} has no parameter {} of {}", report.model(),
                              from.parameter(), from.term()));
  }
  return out;
}

Result<std::vector<StateSpace>> array_systems(const v1::ArrayReport& report) {
  const auto model = array_model(report);
  if (!model) return tl::unexpected(model.error());
  const std::vector<std::string> names(report.sensors().begin(), report.sensors().end());
  auto array = state_space(*model, names, Hertz{report.rate_hz()});
  if (!array) return tl::unexpected(array.error());
  std::vector<StateSpace> out = {std::move(*array)};
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(report.sensors_size());
  for (const v1::SensorWeight& one : report.virtual_sensor().weights()) {
    const Index s = sensor_index(report, one.sensor());
    if (s < 0) return fail(fmt::format("a weight of an unknown sensor '{}'", one.sensor()));
    weights(s) = one.weight();
  }
  if (report.has_virtual_sensor()) out.push_back(virtual_output(out.front(), weights));
  return out;
}

}  // namespace imunoise::study
