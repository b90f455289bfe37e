#include "study/report/axis.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace imunoise::report {
namespace {

constexpr double kMinorGap = 14.0;  // px a decade's step from 1 to 2 needs before minor ticks crowd

double power(int exponent) { return std::pow(10.0, exponent); }

}  // namespace

void LogRange::include(double value) {
  if (!std::isfinite(value) || value <= 0.0) return;
  low_ = std::min(low_, value);
  high_ = std::max(high_, value);
}

bool drawable(double value) { return std::isfinite(value) && value > 0.0; }

LogAxis::LogAxis(double low, double high, double begin, double end)
    : low_(low), high_(high), begin_(begin), end_(end) {
  assert(low > 0.0 && low < high);
}

double LogAxis::operator()(double value) const {
  assert(value > 0.0);
  return begin_ + (end_ - begin_) * std::log(value / low_) / std::log(high_ / low_);
}

std::vector<Tick> LogAxis::decade_ticks(double label) const {
  const double decade_length = std::abs(end_ - begin_) / std::log10(high_ / low_);
  const int every = std::max(1, static_cast<int>(std::ceil(label / decade_length)));
  const bool minors = every == 1 && decade_length * std::log10(2.0) > kMinorGap;
  std::vector<Tick> out;
  const int last = static_cast<int>(std::floor(std::log10(high_)));
  for (int e = static_cast<int>(std::floor(std::log10(low_))); e <= last; ++e) {
    for (int digit = 1; digit <= (minors ? 9 : 1); ++digit) {
      const double value = digit * power(e);
      if (holds(value)) out.push_back({value, digit == 1 && e % every == 0});
    }
  }
  return out;
}

std::vector<Tick> LogAxis::fine_ticks(double label) const {
  const double decade_length = std::abs(end_ - begin_) / std::log10(high_ / low_);
  std::vector<Tick> out = decade_ticks(label);
  if (decade_length * std::log10(2.0) < label) return out;
  for (Tick& tick : out) {
    const double digit = std::round(
        tick.value / power(static_cast<int>(std::floor(std::log10(tick.value * 1.0001)))));
    tick.major = digit == 1.0 || digit == 2.0 || digit == 5.0;
  }
  return out;
}

LinearAxis::LinearAxis(double low, double high, double begin, double end)
    : low_(low), high_(high), begin_(begin), end_(end) {
  assert(low < high);
}

double LinearAxis::operator()(double value) const {
  return begin_ + (end_ - begin_) * (value - low_) / (high_ - low_);
}

std::vector<double> LinearAxis::ticks(double label) const {
  const double least = (high_ - low_) * std::min(1.0, label / std::abs(end_ - begin_));
  const double decade = power(static_cast<int>(std::floor(std::log10(least))));
  const double digit = least / decade;
  const double step = decade * (digit <= 1.0   ? 1.0
                                : digit <= 2.0 ? 2.0
                                : digit <= 5.0 ? 5.0
                                               : 10.0);
  const double slack = 1e-9 * step;
  std::vector<double> out;
  for (double k = std::ceil((low_ - slack) / step); k * step <= high_ + slack; k += 1.0) {
    out.push_back(k * step + 0.0);  // zero without a sign
  }
  return out;
}

SigmaAxis::SigmaAxis(double reach, double centre, double half)
    : reach_(reach), centre_(centre), half_(half) {
  assert(reach > 0.0);
}

double SigmaAxis::operator()(double sigma) const {
  return centre_ - half_ * std::asinh(sigma / 2.0) / std::asinh(reach_ / 2.0);
}

std::vector<double> SigmaAxis::ticks() const {
  std::vector<double> out = {0.0, 2.0, -2.0};
  for (double decade = 1.0; 5.0 * decade <= reach_; decade *= 10.0) {
    for (const double step : {5.0 * decade, 10.0 * decade, 20.0 * decade}) {
      if (step > reach_) break;
      out.push_back(step);
      out.push_back(-step);
    }
  }
  return out;
}

}  // namespace imunoise::report
