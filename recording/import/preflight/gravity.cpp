#include "recording/import/preflight/gravity.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>

#include "recording/import/table/names.h"

namespace imunoise::recording {
namespace {

constexpr double kGravity = 9.80665;  // m/s^2
constexpr double kTolerance = 0.2;    // of scale errors and biases

struct Moments {
  double mean = 0.0;
  double deviation = 0.0;  // standard
};

// Of some samples of a column, in its unit.
Moments moments_of(const Column& column) {
  double sum = 0.0;
  double squares = 0.0;
  std::size_t count = 0;
  std::visit(
      [&](const auto& values) {
        const std::size_t stride = std::max<std::size_t>(1, values.size() / 4096);
        for (std::size_t i = 0; i < values.size(); i += stride) {
          const auto value = static_cast<double>(values[i]);
          if (!std::isfinite(value)) continue;
          sum += value;
          squares += value * value;
          ++count;
        }
      },
      column.samples);
  if (count == 0) return {};
  const double mean = sum / static_cast<double>(count);
  const double variance = squares / static_cast<double>(count) - mean * mean;
  return {column.offset + column.scale * mean,
          std::abs(column.scale) * std::sqrt(std::max(0.0, variance))};
}

double mean_of(const Column& column) { return moments_of(column).mean; }

bool near(double value, double wanted) { return std::abs(value / wanted - 1.0) < kTolerance; }

// The unit in which gravity is that number.
std::optional<std::string_view> unit_of_gravity(double norm) {
  if (near(norm, 1.0)) return "g";
  if (near(norm, kGravity)) return "m/s^2";
  if (near(norm, 1000.0)) return "mg";
  return std::nullopt;
}

// A rate of this mean is no bias, and one of this scatter no noise: the sensor turns, or the unit
// is wrong (rad/s).
constexpr double kLargestMean = 0.5;
constexpr double kLargestScatter = 0.1;

// By what the norm of three axes is at rest.
void judge_norm(const std::vector<Column>& columns, const std::vector<std::size_t>& axes,
                std::vector<Unit>& units, std::vector<std::string>& said,
                std::vector<Finding>& findings) {
  double squares = 0.0;
  const double to_si = units[axes[0]].to_si;
  for (const std::size_t c : axes) {
    if (units[c].symbol != units[axes[0]].symbol) return;
    squares += std::pow(mean_of(columns[c]), 2);
  }
  const double norm = std::sqrt(squares);
  const std::string names = fmt::format("{}, {}, {}", columns[axes[0]].name, columns[axes[1]].name,
                                        columns[axes[2]].name);
  if (units[axes[0]].quantity == Quantity::kUnknown) {
    const auto symbol = unit_of_gravity(norm);
    if (!symbol) {
      findings.push_back(
          {Severity::kDoubt,
           fmt::format("accelerations {}: no unit is stated and their norm is {:.4g}, neither 1 g "
                       "nor 9.81 m/s^2; give --unit 'acc_*=UNIT', such as 'acc_*=1/16384 g' for "
                       "counts",
                       names, norm)});
      return;
    }
    for (const std::size_t c : axes) units[c] = *parse_unit(*symbol);
    said.push_back(
        fmt::format("accelerations {}: {} (their norm is {:.4g})", names, *symbol, norm));
  } else if (!near(norm * to_si, kGravity)) {
    findings.push_back(
        {Severity::kDoubt,
         fmt::format("accelerations {} are stated in {}, but their norm at rest is {:.4g} m/s^2, "
                     "not 9.81; correct the unit with --unit 'acc_*={}'",
                     names, units[axes[0]].symbol, norm * to_si,
                     unit_of_gravity(norm).value_or("UNIT"))});
  }
}

void judge_rates(const std::vector<Column>& columns, const std::vector<Unit>& units,
                 std::size_t wanted, std::vector<Finding>& findings) {
  for (std::size_t c = 0; c < wanted; ++c) {
    if (units[c].quantity != Quantity::kAngularRate) continue;
    const Moments found = moments_of(columns[c]);
    const double mean = found.mean * units[c].to_si;
    const double scatter = found.deviation * units[c].to_si;
    if (std::abs(mean) < kLargestMean && scatter < kLargestScatter) continue;
    findings.push_back(
        {Severity::kDoubt,
         fmt::format("{} has a mean of {:.3g} and a scatter of {:.3g} rad/s at rest: does the "
                     "sensor turn, or is {} the wrong unit?",
                     columns[c].name, mean, scatter, units[c].symbol)});
    return;  // the other axes would say the same
  }
}

}  // namespace

std::vector<std::string> judge_acceleration(const std::vector<Column>& columns,
                                            std::vector<Unit>& units, std::size_t wanted,
                                            std::vector<Finding>& findings) {
  std::map<std::string, std::vector<std::size_t>> axes;  // of each sensor
  std::string silent;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const Role role = role_of(columns[c].name);
    if (role.quantity == Quantity::kAcceleration && role.axis != ' ')
      axes[role.sensor].push_back(c);
    if (c < wanted && role.quantity == Quantity::kAngularRate &&
        units[c].quantity == Quantity::kUnknown)
      silent += (silent.empty() ? "" : ", ") + columns[c].name;
  }
  if (!silent.empty())
    findings.push_back(
        {Severity::kDoubt,
         fmt::format("{}: no unit is stated; give --unit 'gyro_*=deg/s' or rad/s", silent)});
  judge_rates(columns, units, wanted, findings);
  std::vector<std::string> said;
  for (const auto& [sensor, of_sensor] : axes) {
    if (of_sensor.size() == 3) judge_norm(columns, of_sensor, units, said, findings);
  }
  return said;
}

std::vector<std::string> rates_of_increments(std::vector<Column>& columns, Hertz rate) {
  std::string made;
  std::vector<std::size_t> accelerations;  // that may be velocities
  std::vector<std::size_t> rates;          // that may be angles: what the accelerations are
  bool stated = true;                      // the accelerations' unit
  double squares = 0.0;                    // SI where the unit is stated
  const auto make = [&](Column& column, std::string unit) {
    column.scale *= rate.value;
    column.offset *= rate.value;
    column.unit = std::move(unit);
    made += (made.empty() ? "" : ", ") + column.name;
  };
  for (std::size_t c = 0; c < columns.size(); ++c) {
    Column& column = columns[c];
    const Role role = role_of(column.name);
    const std::string& unit = column.unit;
    const bool none = unit.empty() || unit == "-";
    const auto known = parse_unit(unit);
    const bool silent = none && role.unit.empty();
    const bool of_its_kind = known && known->quantity == role.quantity;
    if (role.quantity == Quantity::kAngularRate) {
      if (role.increment && (none || unit == "rad" || unit == "deg")) {
        make(column, none ? "" : unit + "/s");
      } else if (role.axis != ' ' && (silent || of_its_kind)) {
        rates.push_back(c);
      }
    } else if (role.quantity == Quantity::kAcceleration) {
      if (role.increment && (none || unit == "m/s")) {
        make(column, none ? "" : "m/s^2");
      } else if (role.axis != ' ' && (silent || of_its_kind)) {
        accelerations.push_back(c);
        stated = stated && !none;
        squares += std::pow(mean_of(column) * (none ? 1.0 : known->to_si), 2);
      }
    }
  }
  // The norm of accelerations in g or m/s^2 tells them from increments.
  const double norm = std::sqrt(squares);
  if (accelerations.size() == 3 && near(norm * rate.value, kGravity) && !near(norm, 1.0) &&
      !near(norm, kGravity) && !near(norm, 1000.0)) {
    for (const std::size_t c : accelerations) make(columns[c], stated ? columns[c].unit : "m/s^2");
    for (const std::size_t c : rates) {
      // Where a header states units for increments, it may do so for all, if they are then at rest.
      const auto unit = parse_unit(columns[c].unit);
      const bool silent = !unit || unit->quantity == Quantity::kUnknown;
      const bool still =
          !silent && moments_of(columns[c]).deviation * rate.value * unit->to_si < kLargestScatter;
      if (silent || (stated && still)) make(columns[c], silent ? "" : columns[c].unit);
    }
  }
  if (made.empty()) return {};
  return {fmt::format("increments: {}, divided by {:.6g} s", made, 1.0 / rate.value)};
}

}  // namespace imunoise::recording
