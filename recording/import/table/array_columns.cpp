#include "recording/import/table/array_columns.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>

#include "recording/import/table/names.h"

namespace imunoise::recording {

std::vector<std::string> column_names(std::string_view array, std::uint64_t columns) {
  if (columns == 1) return {std::string(array)};
  const bool axes =
      columns == 3 && role_of(fmt::format("{}_x", array)).quantity != Quantity::kUnknown;
  std::vector<std::string> out;
  for (std::uint64_t c = 0; c < columns; ++c) {
    out.push_back(axes ? fmt::format("{}_{}", array, "xyz"[c])
                       : fmt::format("{}_{}", array, c + 1));
  }
  return out;
}

std::uint64_t common_length(const std::vector<Shape>& shapes) {
  const bool recorded = std::any_of(shapes.begin(), shapes.end(),
                                    [](const Shape& one) { return one.may_be_recorded(); });
  std::map<std::uint64_t, std::uint64_t> columns;
  for (const Shape& one : shapes) {
    if (recorded ? one.may_be_recorded() : one.longer() > 1) columns[one.longer()] += one.shorter();
  }
  const auto most =
      std::max_element(columns.begin(), columns.end(),
                       [](const auto& a, const auto& b) { return a.second <= b.second; });
  return most == columns.end() ? 0 : most->first;
}

double rate_called(std::string_view name, double value) {
  constexpr std::array<std::string_view, 11> rates = {
      "fs",           "rate",          "ratehz",     "rate_hz",     "samplerate", "sample_rate",
      "samplingrate", "sampling_rate", "samplefreq", "sample_freq", "freq"};
  constexpr std::array<std::string_view, 5> periods = {"dt", "ts", "period", "delta_t", "deltat"};
  std::string lower(last_part(name));
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (!(value > 0.0)) return 0.0;
  if (std::find(rates.begin(), rates.end(), lower) != rates.end()) return value;
  if (std::find(periods.begin(), periods.end(), lower) != periods.end()) return 1.0 / value;
  return 0.0;
}

bool rises_steadily(const std::vector<double>& numbers) {
  if (numbers.size() < kMinimumSamples) return false;
  std::vector<double> steps;
  steps.reserve(numbers.size() - 1);
  for (std::size_t i = 1; i < numbers.size(); ++i) steps.push_back(numbers[i] - numbers[i - 1]);
  if (!std::all_of(steps.begin(), steps.end(), [](double step) { return step > 0.0; }))
    return false;
  if (std::all_of(steps.begin(), steps.end(), [](double step) { return step == 1.0; }))
    return false;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  const double usual = *middle;
  const auto even = std::count_if(steps.begin(), steps.end(),
                                  [&](double step) { return std::abs(step / usual - 1.0) < 0.5; });
  return static_cast<double>(even) > 0.9 * static_cast<double>(steps.size());
}

std::string_view last_part(std::string_view name) {
  const std::size_t at = name.find_last_of("./");
  return at == std::string_view::npos ? name : name.substr(at + 1);
}

}  // namespace imunoise::recording
