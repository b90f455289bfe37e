#include "recording/import/preflight/suspect.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <string_view>

#include "core/integrity/interpolation.h"
#include "core/support/neighbour_steps.h"
#include "recording/import/table/names.h"

namespace imunoise::recording {
namespace {

constexpr std::size_t kMostRows = std::size_t{1} << 18U;
constexpr std::size_t kFewestRows = 1024;
constexpr std::size_t kApart = 16;    // rows that agree by chance
constexpr double kMoreOften = 5.0;    // than by chance
constexpr double kRepeats = 0.02;     // of the rows, at least
constexpr double kLines = 0.05;       // of the rows, at least
constexpr double kStraight = 1e-3;    // of the rms second difference
constexpr std::size_t kSegment = 64;  // samples of a spectrum's segment
constexpr double kFalls = 0.1;        // -10 dB
constexpr double kFlat = 2.5;         // between bins 2 to 3 and 4 to 6
constexpr std::size_t kGroup = 4;     // samples averaged to see lower frequencies
constexpr std::size_t kMostSegments = 2048;

using Axes = std::vector<std::vector<double>>;

double fraction(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

// How many rows equal the row `lag` before, on all axes.
double agreeing(const Axes& axes, std::size_t lag) {
  std::size_t count = 0;
  const std::size_t rows = axes.front().size();
  for (std::size_t i = lag; i < rows; ++i) {
    count += std::all_of(axes.begin(), axes.end(),
                         [&](const auto& axis) { return axis[i] == axis[i - lag]; })
                 ? 1U
                 : 0U;
  }
  return fraction(count, rows - lag);
}

// How often neighbours of an axis are the same number by chance: steps of a smooth series are
// normal, and rounding to a quantum makes those of less than one zero, the likelier the smaller.
double equal_by_chance(const std::vector<double>& axis) {
  const NeighbourSteps steps = neighbour_steps(axis);
  const double quantum = steps.smallest;
  const double variance = steps.mean_square - quantum * quantum / 6.0;  // that rounding adds
  if (!(variance > 0.0)) return 1.0;
  const double z = quantum / std::sqrt(variance);
  return std::erf(z / std::numbers::sqrt2) -
         std::sqrt(2.0 / std::numbers::pi) / z * (1.0 - std::exp(-0.5 * z * z));
}

double equal_by_chance(const Axes& axes) {
  double out = 1.0;
  for (const auto& axis : axes) out *= equal_by_chance(axis);
  return out;
}

struct Lines {
  double joint = 0.0;   // of the rows, on all axes
  double chance = 1.0;  // if the axes were independent
};

Lines straight_lines(const Axes& axes) {
  const std::size_t rows = axes.front().size();
  std::vector<bool> all(rows, true);
  Lines out;
  for (const auto& axis : axes) {
    double squares = 0.0;
    const auto bend = [&](std::size_t i) { return axis[i] - 2.0 * axis[i - 1] + axis[i - 2]; };
    for (std::size_t i = 2; i < rows; ++i) squares += bend(i) * bend(i);
    const double limit = kStraight * std::sqrt(squares / static_cast<double>(rows - 2));
    for (std::size_t i = 2; i < rows; ++i) {
      if (std::abs(bend(i)) >= limit || axis[i] == axis[i - 1]) all[i] = false;
    }
    // Coarse numbers lie on lines about as often as they agree.
    out.chance *= 0.01 + agreeing({axis}, kApart);
  }
  out.joint =
      fraction(static_cast<std::size_t>(std::count(all.begin() + 2, all.end(), true)), rows - 2);
  return out;
}

using Spectrum = std::array<double, kSegment / 2 + 1>;

// Mean power in bins 0 to 32 of segments, in any unit.
Spectrum power_of(const std::vector<double>& axis) {
  Spectrum out = {};
  static const auto table = [] {
    std::array<double, kSegment> cosines;
    for (std::size_t i = 0; i < kSegment; ++i) {
      cosines[i] =
          std::cos(2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(kSegment));
    }
    return cosines;
  }();
  const std::size_t segments = axis.size() / kSegment;
  const std::size_t stride = std::max<std::size_t>(1, segments / kMostSegments);
  const auto used = static_cast<double>((segments + stride - 1) / stride);
  for (std::size_t s = 0; s < segments; s += stride) {
    const double* const from = axis.data() + s * kSegment;
    double mean = 0.0;
    for (std::size_t i = 0; i < kSegment; ++i) mean += from[i] / static_cast<double>(kSegment);
    for (std::size_t k = 0; k < out.size(); ++k) {
      double real = 0.0;
      double imaginary = 0.0;
      for (std::size_t i = 0; i < kSegment; ++i) {
        const double windowed = (from[i] - mean) * (0.5 - 0.5 * table[i]);
        real += windowed * table[(i * k) % kSegment];
        imaginary += windowed * table[(i * k + kSegment / 4 * 3) % kSegment];
      }
      out[k] += (real * real + imaginary * imaginary) / used;
    }
  }
  return out;
}

double mean_of_bins(const Spectrum& power, std::size_t first, std::size_t last) {
  double sum = 0.0;
  for (std::size_t k = first; k <= last; ++k) sum += power[k];
  return sum / static_cast<double>(last - first + 1);
}

double plateau(const Spectrum& power) { return mean_of_bins(power, 2, 6); }
double top(const Spectrum& power) { return mean_of_bins(power, 26, 31); }

// The fraction of the rate from which on the power is less than half; 0: no filter.
double cut_off_in(const Spectrum& power) {
  const double low = mean_of_bins(power, 2, 3);
  const double middle = mean_of_bins(power, 4, 6);
  const bool flat = low <= kFlat * middle && middle <= kFlat * low;
  if (!(low > 0.0) || !flat || top(power) > kFalls * std::min(low, middle)) return 0.0;
  std::size_t k = 4;
  while (k < 31 && power[k] > 0.5 * low) ++k;
  return static_cast<double>(k) / static_cast<double>(kSegment);
}

std::vector<double> mean_of_groups(const std::vector<double>& axis) {
  std::vector<double> out(axis.size() / kGroup);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto first = axis.begin() + static_cast<std::ptrdiff_t>(i * kGroup);
    out[i] = std::accumulate(first, first + static_cast<std::ptrdiff_t>(kGroup), 0.0) /
             static_cast<double>(kGroup);
  }
  return out;
}

// The same of a filter far below the rate, too: means of neighbours show where it is flat. It
// leaves next to nothing at the highest frequencies, where a sensor without filter has white noise
// beside a bias that wanders.
double cut_off(const std::vector<double>& axis) {
  constexpr double kNothing = 0.01;  // -20 dB
  const Spectrum all = power_of(axis);
  const double out = cut_off_in(all);
  if (out > 0.0 || axis.size() < kGroup * kFewestRows) return out;
  const Spectrum slow = power_of(mean_of_groups(axis));
  // A mean of n white samples has an nth of their power.
  if (top(all) > kNothing * plateau(slow) * static_cast<double>(kGroup)) return 0.0;
  return cut_off_in(slow) / static_cast<double>(kGroup);
}

// What a channel measures, by its unit, else by its name.
Quantity quantity_of(const Column& column, const Unit& unit) {
  return unit.quantity == Quantity::kUnknown ? role_of(column.name).quantity : unit.quantity;
}

void suspect(const Axes& axes, std::string_view sensor, Hertz rate,
             std::vector<Finding>& findings) {
  const double repeats = agreeing(axes, 1);
  const double chance = std::max(agreeing(axes, kApart), equal_by_chance(axes));
  if (repeats > kRepeats && repeats > kMoreOften * chance) {
    findings.push_back(
        {Severity::kDoubt,
         fmt::format(
             "{:.3g} % of the {} repeat the sample before: the sensor gives about {:.4g} Hz; "
             "read it at its own rate",
             100.0 * repeats, sensor, rate.value * (1.0 - repeats))});
    return;
  }
  const Lines lines = straight_lines(axes);
  if (axes.size() > 1 && lines.joint > kLines && lines.joint > kMoreOften * lines.chance) {
    findings.push_back(
        {Severity::kDoubt,
         fmt::format("{:.3g} % of the {} lie on straight lines between their neighbours: they were "
                     "interpolated, which hides noise; read the raw samples",
                     100.0 * lines.joint, sensor)});
    return;
  }
  for (const auto& axis : axes) {
    const double beat = interpolation_beat(axis);
    if (beat == 0.0) continue;
    findings.push_back(
        {Severity::kDoubt,
         fmt::format("the {} were interpolated from another sampling rate, with which they beat at "
                     "{:.4g} Hz: that hides noise; read the raw samples",
                     sensor, beat * rate.value)});
    return;
  }
  double lowest = 1.0;
  for (const auto& axis : axes) lowest = std::min(lowest, cut_off(axis));
  if (lowest <= 0.0) return;
  findings.push_back(
      {Severity::kDoubt,
       fmt::format("the power of the {} falls from about {:.3g} Hz on: the stream was filtered; a "
                   "model without the filter holds below that frequency only",
                   sensor, lowest * rate.value)});
}

// Tells of axes that never change, and takes them out. True: no other is left.
bool leave_out_constant(const std::vector<std::string>& names, std::string_view sensor, Axes& axes,
                        std::vector<Finding>& findings) {
  Axes moving;
  std::string still;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const auto& values = axes[a];
    if (std::all_of(values.begin(), values.end(), [&](double one) { return one == values[0]; }))
      still += (still.empty() ? "" : ", ") + names[a];
    else
      moving.push_back(std::move(axes[a]));
  }
  if (!still.empty())
    findings.push_back(
        {Severity::kDoubt,
         fmt::format("{} of the {} never changes: is the axis connected?", still, sensor)});
  axes = std::move(moving);
  return axes.empty();
}

}  // namespace

void find_suspects(const std::vector<Column>& columns, const std::vector<Unit>& units,
                   std::size_t wanted, Hertz rate, std::size_t begin, std::size_t count,
                   std::vector<Finding>& findings) {
  count = std::min(count, kMostRows);
  if (count < kFewestRows) return;
  for (const auto& [quantity, sensor] : {std::pair{Quantity::kAngularRate, "angular rates"},
                                         {Quantity::kAcceleration, "accelerations"}}) {
    Axes axes;
    std::vector<std::string> names;
    bool asked = false;
    for (std::size_t c = 0; c < columns.size() && axes.size() < 3; ++c) {
      if (quantity_of(columns[c], units[c]) != quantity) continue;
      names.push_back(columns[c].name);
      asked = asked || c < wanted;
      std::visit(
          [&](const auto& values) {
            const auto from = values.begin() + static_cast<std::ptrdiff_t>(begin);
            axes.emplace_back(from, from + static_cast<std::ptrdiff_t>(count));
          },
          columns[c].samples);
    }
    if (!asked) continue;
    const bool still = leave_out_constant(names, sensor, axes, findings);
    if (!axes.empty() && !still) suspect(axes, sensor, rate, findings);
  }
}

}  // namespace imunoise::recording
