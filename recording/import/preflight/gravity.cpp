#include "recording/import/preflight/gravity.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "recording/import/table/names.h"

namespace imunoise::recording {
namespace {

constexpr double kGravity = 9.80665;  // m/s^2
constexpr double kTolerance = 0.2;    // of scale errors and biases

// Mean of some samples of a column, as stored in its unit.
double mean_of(const Column& column) {
  double sum = 0.0;
  std::size_t count = 0;
  std::visit(
      [&](const auto& values) {
        const std::size_t stride = std::max<std::size_t>(1, values.size() / 4096);
        for (std::size_t i = 0; i < values.size(); i += stride) {
          const auto value = static_cast<double>(values[i]);
          if (!std::isfinite(value)) continue;
          sum += value;
          ++count;
        }
      },
      column.samples);
  return count == 0 ? 0.0 : column.offset + column.scale * sum / static_cast<double>(count);
}

bool near(double value, double wanted) { return std::abs(value / wanted - 1.0) < kTolerance; }

}  // namespace

std::vector<std::string> judge_acceleration(const std::vector<Column>& columns,
                                            std::vector<Unit>& units,
                                            std::vector<Finding>& findings) {
  std::vector<std::size_t> axes;
  std::string silent;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const Role role = role_of(columns[c].name);
    if (role.quantity == Quantity::kAcceleration && role.axis != ' ' && !role.increment)
      axes.push_back(c);
    if (role.quantity == Quantity::kAngularRate && units[c].quantity == Quantity::kUnknown)
      silent += (silent.empty() ? "" : ", ") + columns[c].name;
  }
  if (!silent.empty())
    findings.push_back(
        {Severity::kDoubt,
         fmt::format("{}: no unit is stated; give --unit 'gyro_*=deg/s' or rad/s", silent)});
  std::vector<std::string> said;
  if (axes.size() != 3) return said;
  double squares = 0.0;
  double to_si = units[axes[0]].to_si;
  for (const std::size_t c : axes) {
    if (units[c].symbol != units[axes[0]].symbol) return said;
    squares += std::pow(mean_of(columns[c]), 2);
  }
  const double norm = std::sqrt(squares);
  if (units[axes[0]].quantity == Quantity::kUnknown) {
    const char* const symbol = near(norm, 1.0)        ? "g"
                               : near(norm, kGravity) ? "m/s^2"
                               : near(norm, 1000.0)   ? "mg"
                                                      : nullptr;
    if (symbol == nullptr) {
      findings.push_back(
          {Severity::kDoubt,
           fmt::format("accelerations: no unit is stated and their norm is {:.4g}, neither 1 g nor "
                       "9.81 m/s^2; give --unit 'acc_*=UNIT'",
                       norm)});
      return said;
    }
    for (const std::size_t c : axes) units[c] = *parse_unit(symbol);
    said.push_back(fmt::format("accelerations: {} (their norm is {:.4g})", symbol, norm));
  } else if (!near(norm * to_si, kGravity)) {
    findings.push_back(
        {Severity::kDoubt,
         fmt::format("accelerations are stated in {}, but their norm at rest is {:.4g} m/s^2, not "
                     "9.81; correct the unit with --unit 'acc_*=UNIT'",
                     units[axes[0]].symbol, norm * to_si)});
  }
  return said;
}

std::vector<std::string> rates_of_increments(std::vector<Column>& columns, Hertz rate) {
  std::string made;
  std::vector<std::size_t> silent;  // accelerations without a unit
  double squares = 0.0;
  const auto make = [&](Column& column, const char* unit) {
    column.scale *= rate.value;
    column.offset *= rate.value;
    column.unit = unit;
    made += (made.empty() ? "" : ", ") + column.name;
  };
  for (std::size_t c = 0; c < columns.size(); ++c) {
    Column& column = columns[c];
    const Role role = role_of(column.name);
    const std::string& unit = column.unit;
    const bool none = unit.empty() || unit == "-";
    if (role.increment && role.quantity == Quantity::kAngularRate) {
      if (none || unit == "rad") make(column, "rad/s");
      if (unit == "deg") make(column, "deg/s");
    } else if (role.increment && role.quantity == Quantity::kAcceleration) {
      if (none || unit == "m/s") make(column, "m/s^2");
    } else if (none && role.unit.empty() && role.quantity == Quantity::kAcceleration &&
               role.axis != ' ') {
      silent.push_back(c);
      squares += std::pow(mean_of(column), 2);
    }
  }
  // The norm of accelerations in g or m/s^2 tells them from increments.
  const double norm = std::sqrt(squares);
  if (silent.size() == 3 && near(norm * rate.value, kGravity) && !near(norm, 1.0) &&
      !near(norm, kGravity) && !near(norm, 1000.0)) {
    for (const std::size_t c : silent) make(columns[c], "m/s^2");
  }
  if (made.empty()) return {};
  return {fmt::format("increments: {}, divided by {:.6g} s", made, 1.0 / rate.value)};
}

}  // namespace imunoise::recording
