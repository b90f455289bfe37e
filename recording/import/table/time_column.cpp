#include "recording/import/table/time_column.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace imunoise::recording {
namespace {

constexpr std::array<std::pair<std::string_view, double>, 4> kSuffixes = {
    {{"_s", 1.0}, {"_ms", 1e-3}, {"_us", 1e-6}, {"_ns", 1e-9}}};

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

bool is_bare_time_name(std::string_view name) {
  return name == "t" || name == "time" || name == "timestamp";
}

// Median of at most 65536 steps spread over the column; 0 when there is none.
double median_step(std::span<const double> times) {
  constexpr std::size_t most = std::size_t{1} << 16U;
  const std::size_t stride = std::max<std::size_t>(1, (times.size() - 1) / most);
  std::vector<double> steps;
  for (std::size_t i = 1; i < times.size(); i += stride) {
    const double step = times[i] - times[i - 1];
    if (step > 0.0) steps.push_back(step);
  }
  if (steps.empty()) return 0.0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

// The number with the fewest digits within a relative distance of `value`.
double shortest(double value, double relative) {
  for (int digits = 1; digits < 17; ++digits) {
    const double candidate = std::stod(fmt::format("{:.{}e}", value, digits - 1));
    if (std::abs(candidate / value - 1.0) <= relative) return candidate;
  }
  return value;
}

constexpr std::string_view kWayOut =
    "split the file there: nothing is interpolated (where only the stamps are coarse, --rate HZ "
    "ignores them)";

}  // namespace

bool is_time_name(std::string_view name) {
  const std::string text = lower(name);
  if (is_bare_time_name(text)) return true;
  return std::any_of(kSuffixes.begin(), kSuffixes.end(), [&](const auto& suffix) {
    return text.ends_with(suffix.first) &&
           is_bare_time_name(std::string_view(text).substr(0, text.size() - suffix.first.size()));
  });
}

Result<std::optional<double>> time_unit(std::string_view name, std::string_view unit) {
  if (unit.empty()) {
    const std::string text = lower(name);
    for (const auto& [suffix, seconds] : kSuffixes) {
      if (text.ends_with(suffix)) return std::optional(seconds);
    }
    return std::optional<double>();
  }
  if (unit == "s" || unit == "sec" || unit == "seconds") return std::optional(1.0);
  if (unit == "ms") return std::optional(1e-3);
  if (unit == "us" || unit == "µs" || unit == "μs") return std::optional(1e-6);
  if (unit == "ns") return std::optional(1e-9);
  return fail(
      fmt::format("'{}' is not a unit of time that is known here (s, ms, us, ns); correct it, "
                  "or give --rate HZ to ignore the times",
                  unit));
}

Result<EvenTimes> even_times(std::span<const double> times, const TimeColumn& column) {
  if (times.size() < 2) {
    return fail(fmt::format(
        "{}: cannot derive the sampling rate from one time stamp; pass --rate HZ", column.place));
  }
  const double median = median_step(times);
  double scatter = 0.0;
  double squares = 0.0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const double step = times[i] - times[i - 1];
    const auto trouble = [&](const std::string& what) {
      return fail(fmt::format("{}: {}: {}; {}", column.place, column.row(i), what, kWayOut));
    };
    if (step < 0.0) {
      return trouble(fmt::format("time goes backwards ({} after {})", times[i], times[i - 1]));
    }
    if (step == 0.0) return trouble(fmt::format("time {} occurs twice", times[i]));
    if (step > 1.5 * median) {
      return trouble(
          fmt::format("a gap: time steps by {:.6g} where {:.6g} is usual, about {:.0f} "
                      "samples are missing",
                      step, median, std::max(1.0, std::round(step / median) - 1.0)));
    }
    if (step < 0.5 * median) {
      return trouble(
          fmt::format("uneven: time steps by {:.6g} where {:.6g} is usual", step, median));
    }
    scatter = std::max(scatter, std::abs(step - median));
    squares += (step - median) * (step - median);
  }
  if (!column.seconds && median > 1.0) {
    return fail(
        fmt::format("{}: states no unit and steps by {:.6g}; write the unit into the header, "
                    "e.g. 'time [ms]', or give --rate HZ",
                    column.place, median));
  }
  const double span = times.back() - times.front();
  const double mean = span / static_cast<double>(times.size() - 1) * column.seconds.value_or(1.0);
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon() *
                          std::max(std::abs(times.front()), std::abs(times.back()));
  const double hertz = 1.0 / mean;
  if (!std::isfinite(span) || !std::isfinite(hertz) || hertz <= 0.0) {
    return fail(fmt::format("{}: shows no usable rate; give --rate HZ", column.place));
  }
  const double jitter = std::sqrt(0.5 * squares / static_cast<double>(times.size() - 1)) / median;
  return EvenTimes{Hertz{shortest(hertz, std::max(1e-12, (scatter + rounding) / span))}, jitter};
}

}  // namespace imunoise::recording
