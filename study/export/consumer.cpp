#include "study/export/consumer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/support/json_text.h"
#include "study/words/number.h"

namespace imunoise::study {
namespace {

// The axis as if N and K were at one end of their intervals.
AxisNoise at_end(AxisNoise axis, double Bounded::*end) {
  for (Bounded* one : {&axis.n, &axis.k})
    if (one->bounded()) one->value = one->*end;
  return axis;
}

std::string interval_words(const Field& field) {
  std::string out;
  for (const Bounded& one : field.values) {
    if (!one.bounded()) continue;
    out += fmt::format("{}{} … {}", out.empty() ? "" : "; ",
                       report::brief(one.lower, 4, report::Digits::kPlain),
                       report::brief(one.upper, 4, report::Digits::kPlain));
  }
  return out.empty() ? "" : fmt::format(" ({})", out);
}

}  // namespace

void add_field(std::vector<Field>& to, std::string key, const SensorNoise& sensor,
               const std::function<double(const AxisNoise&)>& value, std::string unit,
               std::string formula) {
  if (sensor.axes.empty()) return;
  Field field{std::move(key), {}, std::move(unit), std::move(formula)};
  for (const AxisNoise& one : sensor.axes) {
    field.values.push_back(
        {value(one), value(at_end(one, &Bounded::lower)), value(at_end(one, &Bounded::upper))});
  }
  to.push_back(std::move(field));
}

double density(const AxisNoise& axis) { return axis.n.value; }
double walk(const AxisNoise& axis) { return axis.k.value; }

std::string rate_words(const SensorNoise& sensor) {
  return sensor.axes.empty() ? "" : fmt::format("f = {:g} Hz", sensor.axes.front().rate.value);
}

double rate_of(const ImuNoise& imu) {
  return (imu.gyro.axes.empty() ? imu.accelerometer : imu.gyro).axes.front().rate.value;
}

Markov markov_bias(const AxisNoise& axis) {
  if (axis.k.value > 0.0 || !axis.markov)
    return {axis.k.value * std::sqrt(kEndless / 2.0), kEndless};
  return *axis.markov;
}

std::string value_list(const Field& field, std::string_view open, std::string_view separator,
                       std::string_view close) {
  if (field.values.size() == 1) return fmt::format("{:.7g}", field.values.front().value);
  std::string out(open);
  for (std::size_t i = 0; i < field.values.size(); ++i)
    out += fmt::format("{}{:.7g}", i == 0 ? "" : separator, field.values[i].value);
  return out.append(close);
}

std::string field_words(const Field& field) {
  return fmt::format("{}; {}{}", field.unit, field.formula, interval_words(field));
}

std::string commented(const Sheet& sheet, std::string_view prefix) {
  std::string out;
  for (const std::string& line : sheet.heading)
    out += line.empty() ? fmt::format("{}\n", prefix) : fmt::format("{} {}\n", prefix, line);
  return out;
}

std::string json_comment(const Sheet& sheet, std::string_view indent) {
  std::string out = fmt::format("{}\"comment\": [", indent);
  const char* separator = "\n";
  std::vector<std::string> lines = sheet.heading;
  for (const Field& one : sheet.fields)
    lines.push_back(fmt::format("{}: {}", one.key, field_words(one)));
  for (const std::string& line : lines) {
    if (line.empty()) continue;
    out += fmt::format("{}{}  {}", separator, indent, json_string(line));
    separator = ",\n";
  }
  return out + fmt::format("\n{}],\n", indent);
}

std::string yaml_under(std::string_view root, const Sheet& sheet) {
  std::string out = commented(sheet, "#");
  const std::string_view indent = root.empty() ? "" : "  ";
  if (!root.empty()) out += fmt::format("{}:\n", root);
  for (const Field& one : sheet.fields)
    out += fmt::format("{}{}: {}  # {}\n", indent, one.key, value_list(one), field_words(one));
  return out;
}

std::string yaml(const Sheet& sheet) { return yaml_under("", sheet); }

}  // namespace imunoise::study
