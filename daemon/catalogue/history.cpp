#include "daemon/catalogue/history.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/inference/parameter_history.h"
#include "core/support/distributions.h"
#include "daemon/catalogue/parameter_names.h"

namespace imunoise::catalogue {
namespace {

// The confidence of the intervals that calibrations keep.
constexpr double kConfidence = 0.95;
constexpr double kTests = 2.0;  // the newest one, and a trend

// Takes those that were asked for.
Result<Parameters> chosen(Parameters all, const HistoryOptions& options) {
  std::set<std::string> channels;
  std::set<std::string> names;
  for (const v1::ParameterHistory& one : all) {
    channels.insert(one.channel());
    names.insert(one.term() + "." + one.parameter());
  }
  for (const std::string& wanted : options.channels) {
    if (!channels.contains(wanted)) {
      return fail(fmt::format("channel '{}': no calibration of this device has it; there are {}",
                              wanted, fmt::join(channels, ", ")));
    }
  }
  for (const std::string& wanted : options.parameters) {
    if (std::none_of(all.begin(), all.end(),
                     [&](const auto& one) { return is_called(one, wanted); }))
      return fail(fmt::format("parameter '{}': no calibration of this device has it; there are {}",
                              wanted, fmt::join(names, ", ")));
  }
  std::erase_if(all, [&](const v1::ParameterHistory& one) {
    const auto is_meant = [&](const std::string& wanted) { return is_called(one, wanted); };
    const auto& c = options.channels;
    const auto& p = options.parameters;
    return (!c.empty() && std::find(c.begin(), c.end(), one.channel()) == c.end()) ||
           (!p.empty() && std::none_of(p.begin(), p.end(), is_meant));
  });
  return all;
}

// Marks the points that can be compared, and gives them with days and logarithms; none where the
// newest point is not one of them.
std::vector<DatedEstimate> compared(v1::ParameterHistory& parameter) {
  std::vector<DatedEstimate> out;
  const v1::HistoryPoint newest = *parameter.points().rbegin();
  if (!is_seen(newest)) return out;
  const double reach = 2.0 * normal_quantile(0.5 + 0.5 * kConfidence);
  for (v1::HistoryPoint& point : *parameter.mutable_points()) {
    if (!is_seen(point) || point.model() != newest.model()) continue;
    point.set_compared(true);
    const double error = std::log(point.upper() / point.lower()) / reach;
    const auto days = static_cast<double>(point.started_ns() - newest.started_ns()) / 86400e9;
    out.push_back({days, std::log(point.value()), error * error});
  }
  return out;
}

// `level` is that of one test of one parameter.
void assess(const std::vector<DatedEstimate>& points, double level, v1::ParameterHistory& to) {
  const auto newest = test_newest(points);
  if (!newest) return;
  v1::DriftReport& out = *to.mutable_drift();
  out.set_earlier(static_cast<std::uint32_t>(points.size() - 1));
  out.set_change(std::expm1(newest->change));
  out.set_p_value(newest->p_value);
  out.set_newest_alarm(newest->p_value < level);
  if (const auto trend = test_trend(points)) {
    out.set_trend(std::expm1(trend->change));
    out.set_trend_p_value(trend->p_value);
    out.set_trend_alarm(trend->p_value < level);
  }
  out.set_alarm(out.newest_alarm() || out.trend_alarm());
  const auto history = std::span(points).first(points.size() - 1);
  const auto range = expected_next(history, points.back().variance, level);
  out.set_expected_lower(std::exp(range->lower));
  // A short history may allow anything.
  out.set_expected_upper(std::exp(std::min(range->upper, std::log(1e300))));
}

// Says so when calibrations cannot be compared because they chose other models.
void note_other_models(v1::History& history) {
  std::set<std::string> others;
  for (const v1::ParameterHistory& one : history.parameters()) {
    for (const v1::HistoryPoint& point : one.points()) {
      if (point.model() != one.points().rbegin()->model()) others.insert(point.model());
    }
  }
  if (others.empty()) return;
  history.add_notes(fmt::format(
      "Calibrations of other models are shown but not compared ({}); calibrate with one --model to "
      "compare them all.",
      fmt::join(others, ", ")));
}

// The parameters that a test finds changed.
std::string named(const v1::History& history, bool (v1::DriftReport::*alarm)() const) {
  std::string out;
  for (const v1::ParameterHistory& one : history.parameters()) {
    if (!(one.drift().*alarm)()) continue;
    out += fmt::format("{}{} {} of {}", out.empty() ? "" : ", ", one.channel(), one.parameter(),
                       one.term());
  }
  return out;
}

std::string summary_of(const v1::History& history, std::size_t testable) {
  if (testable == 0) {
    return fmt::format(
        "Too few calibrations to compare: that takes {} earlier ones of the same model, each with "
        "an interval.",
        kLeastHistory);
  }
  const std::string changed = named(history, &v1::DriftReport::newest_alarm);
  const std::string drifting = named(history, &v1::DriftReport::trend_alarm);
  std::string out;
  if (!changed.empty())
    out = fmt::format("Changed: {}, by more than the errors and the usual scatter of this device.",
                      changed);
  if (!drifting.empty())
    out += fmt::format("{}Drifting: {}, along a straight line through all calibrations.",
                       out.empty() ? "" : " ", drifting);
  return out.empty() ? fmt::format(
                           "The newest calibration is compatible with the earlier ones, "
                           "and none drifts ({} parameters).",
                           testable)
                     : out;
}

}  // namespace

Result<v1::History> history_of(const v1::CataloguedDevice& device, Parameters parameters,
                               const HistoryOptions& options) {
  if (parameters.empty()) {
    return fail(fmt::format(
        "device '{}': no calibration of it has a model yet (imunoise calibrate)", device.id()));
  }
  auto wanted = chosen(std::move(parameters), options);
  if (!wanted) return tl::unexpected(wanted.error());
  v1::History out;
  *out.mutable_device() = device;
  out.set_level(options.level);
  std::vector<std::vector<DatedEstimate>> points;
  std::size_t testable = 0;
  for (v1::ParameterHistory& one : *wanted) {
    points.push_back(compared(one));
    testable += points.back().size() > kLeastHistory ? 1U : 0U;
  }
  const double level =
      options.level / (kTests * std::max<double>(1.0, static_cast<double>(testable)));
  for (std::size_t i = 0; i < wanted->size(); ++i) {
    assess(points[i], level, (*wanted)[i]);
    out.set_alarm(out.alarm() || (*wanted)[i].drift().alarm());
    *out.add_parameters() = std::move((*wanted)[i]);
  }
  out.set_summary(summary_of(out, testable));
  note_other_models(out);
  return out;
}

}  // namespace imunoise::catalogue
