#include "study/figure/scale.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "study/figure/time_ticks.h"
#include "study/words/number.h"

namespace imunoise::figure {
namespace {

constexpr double kFewDecades = 3.0;
constexpr double kLatest = 8e9;     // s, of which the nanoseconds can be counted
constexpr double kLargest = 1e290;  // margins still are finite

double power_of_ten(int exponent) { return std::pow(10.0, exponent); }

// Where a value stands before the axis is stretched to 0 .. 1.
double unfolded(AxisKind kind, double value) {
  if (kind == AxisKind::kLogarithmic) return std::log10(value);
  if (kind == AxisKind::kSigma) return std::asinh(0.5 * value);
  return value;
}

// Labels of a few digits stay as they are; large and small ones get an exponent, and the digits
// that tell one step from the next.
std::string number_label(double value, double step) {
  const double size = std::abs(value);
  if (size > 0.0 && (size < 1e-3 || size >= 1e5)) {
    const double digits =
        std::floor(std::log10(size) + 1e-9) - std::floor(std::log10(step) + 1e-9) + 1.0;
    return report::number(value, static_cast<int>(std::clamp(digits, 1.0, 9.0)),
                          report::Digits::kTypeset);
  }
  return (value < 0.0 ? "−" : "") + report::tick_label(size);
}

// "0.02", "500", 10⁵: as short as its size allows.
void label_on_decades(Tick& tick) {
  const double log = std::log10(tick.value);
  const bool whole = std::abs(log - std::round(log)) < 1e-9;
  if (log > -3.01 && log < 3.9) {
    tick.label = report::tick_label(tick.value);
  } else if (whole) {
    tick.exponent = static_cast<int>(std::lround(log));
  } else {
    tick.label = report::number(tick.value, 1, report::Digits::kTypeset);
  }
}

}  // namespace

bool has_place(AxisKind kind, double value) {
  if (kind == AxisKind::kTime) return std::abs(value) < kLatest;
  return std::abs(value) < kLargest && (kind != AxisKind::kLogarithmic || value > 1.0 / kLargest);
}

std::string label_text(const Tick& tick, bool unicode) {
  if (!tick.exponent) return tick.label;
  return unicode ? "10" + report::superscript(*tick.exponent)
                 : "1e" + std::to_string(*tick.exponent);
}

Scale::Scale(AxisKind kind, double low, double high) : kind_(kind), low_(low), high_(high) {
  assert(std::isfinite(low) && std::isfinite(high) && low < high);
  assert(kind != AxisKind::kLogarithmic || low > 0.0);
}

Scale::Scale(std::vector<std::string> categories)
    : kind_(AxisKind::kCategories),
      low_(-0.5),
      high_(static_cast<double>(categories.size()) - 0.5),
      categories_(std::move(categories)) {
  assert(!categories_.empty());
}

double Scale::operator()(double value) const {
  const double low = unfolded(kind_, low_);
  return (unfolded(kind_, value) - low) / (unfolded(kind_, high_) - low);
}

Scale Scale::relabelled(double factor, double exponent) const {
  return {kind_, factor * std::pow(low_, exponent), factor * std::pow(high_, exponent)};
}

std::vector<Tick> Scale::decades(double length, double label, double gap) const {
  const double decade = length / std::log10(high_ / low_);
  const int every = std::max(1, static_cast<int>(std::ceil(label / decade)));
  const bool minors = every == 1 && decade * std::log10(2.0) > gap;
  // Where few decades are named, 1, 2 and 5 are, if they have room.
  const double named_decades = std::floor(std::log10(high_)) - std::ceil(std::log10(low_)) + 1.0;
  const bool fine = named_decades < kFewDecades && decade * std::log10(2.0) > label;
  std::vector<Tick> out;
  const int last = static_cast<int>(std::floor(std::log10(high_)));
  for (int e = static_cast<int>(std::floor(std::log10(low_))); e <= last; ++e) {
    for (int digit = 1; digit <= (minors ? 9 : 1); ++digit) {
      Tick tick{digit * power_of_ten(e)};
      if (!holds(tick.value)) continue;
      tick.major = e % every == 0 && (digit == 1 || (fine && (digit == 2 || digit == 5)));
      if (tick.major) label_on_decades(tick);
      out.push_back(std::move(tick));
    }
  }
  const auto named =
      std::count_if(out.begin(), out.end(), [](const Tick& tick) { return tick.major; });
  // Within a decade round steps say more. They are closest at the upper end.
  const double share = label / length * std::log(high_ / low_) * high_;
  if (named < 2 && share < high_ - low_) {
    std::vector<Tick> even = steps(share);
    std::erase_if(even, [](const Tick& tick) { return tick.value <= 0.0; });
    if (static_cast<std::ptrdiff_t>(even.size()) > named) return even;
  }
  return out;
}

std::vector<Tick> Scale::steps(double least) const {
  if (kind_ == AxisKind::kTime) return time_ticks(low_, high_, least);
  const double step = kind_ == AxisKind::kDuration ? clock_step(least) : round_step(least);
  const double slack = 1e-9 * step;
  std::vector<Tick> out;
  for (double k = std::ceil((low_ - slack) / step); k * step <= high_ + slack; k += 1.0) {
    const double value = k * step + 0.0;  // zero without a sign
    const bool time = kind_ == AxisKind::kDuration && value != 0.0;
    out.push_back({value, true, time ? report::duration(value) : number_label(value, step)});
  }
  return out;
}

std::vector<Tick> Scale::sigmas(double length, double label) const {
  const auto named = [](double value) {
    return Tick{value, true,
                value > 0.0   ? "+" + report::tick_label(value)
                : value < 0.0 ? "−" + report::tick_label(-value)
                              : "0"};
  };
  std::vector<Tick> out;
  if (holds(0.0)) out.push_back(named(0.0));
  double previous = (*this)(0.0);
  const double reach = std::max(high_, -low_);
  const auto pair = [&](double value) {
    if (value > reach) return;
    const bool crowded = std::abs((*this)(value)-previous) * length < label;
    if (!crowded) previous = (*this)(value);
    for (const double signed_value : {value, -value}) {
      if (holds(signed_value)) out.push_back(crowded ? Tick{signed_value} : named(signed_value));
    }
  };
  pair(2.0);
  for (double decade = 1.0; 5.0 * decade <= reach; decade *= 10.0) {
    for (const double step : {5.0 * decade, 10.0 * decade, 20.0 * decade}) pair(step);
  }
  return out;
}

std::vector<Tick> Scale::names(double length, double label) const {
  const double pitch = length / static_cast<double>(categories_.size());
  const auto every = static_cast<std::size_t>(std::max(1.0, std::ceil(label / pitch)));
  std::vector<Tick> out;
  for (std::size_t k = 0; k < categories_.size(); ++k) {
    const bool major = k % every == 0 && !categories_[k].empty();
    out.push_back({static_cast<double>(k), major, major ? categories_[k] : ""});
  }
  return out;
}

std::vector<Tick> Scale::ticks(double length, double label, double gap) const {
  switch (kind_) {
    case AxisKind::kLogarithmic:
      return decades(length, label, gap);
    case AxisKind::kSigma:
      return sigmas(length, label);
    case AxisKind::kCategories:
      return names(length, label);
    default:
      return steps((high_ - low_) * std::min(1.0, label / length));
  }
}

}  // namespace imunoise::figure
