#include "recording/store/timeline/gaps.h"

#include <algorithm>
#include <cmath>

namespace imunoise::recording {
namespace {

constexpr std::size_t kWindow = 32;  // rows; more than a transfer brings at once at usual rates

std::uint64_t lost_in(double periods) {
  return periods < 1.5 ? 0 : static_cast<std::uint64_t>(std::llround(periods)) - 1;
}

double elapsed(const Rows& rows, std::size_t from, std::size_t to) {
  return static_cast<double>(rows.host_time[to]) - static_cast<double>(rows.host_time[from]);
}

// What the counter says about the step to row i.
std::optional<RowGap> counter_gap(const v1::RecordedStream& stream, const Rows& rows, std::size_t i,
                                  double period) {
  const std::uint64_t modulus = stream.counter_modulus();
  const std::uint64_t step = std::max<std::uint64_t>(stream.counter_step(), 1);
  const auto before = static_cast<std::uint64_t>(rows.counter[i - 1]) % modulus;
  const auto now = static_cast<std::uint64_t>(rows.counter[i]) % modulus;
  const std::uint64_t moved = now >= before ? now - before : modulus - before + now;
  const double periods = elapsed(rows, i - 1, i) / period;
  const double wrap = static_cast<double>(modulus) / static_cast<double>(step);
  // More than half way round: the counter wrapped unseen, or went backwards. The clock decides.
  const bool hidden = periods > 1.5 && periods > wrap / 2.0;
  if (hidden || (moved > modulus / 2 && moved != step % modulus)) {
    return RowGap{i, lost_in(periods), hidden ? Evidence::kTime : Evidence::kCounter};
  }
  if (moved == step % modulus) return std::nullopt;
  if (moved == 0) return RowGap{i, 0, Evidence::kDuplicate};
  return RowGap{i, moved % step == 0 ? moved / step - 1 : 0, Evidence::kCounter};
}

// How late row i is against the even grid that row `origin` starts.
double lateness(const Rows& rows, std::size_t origin, std::size_t i, double period) {
  return elapsed(rows, origin, i) - period * (static_cast<double>(i) - static_cast<double>(origin));
}

// What the time stamps say about the step to row i; rows before `known` lie behind an earlier gap.
std::optional<RowGap> time_gap(const Rows& rows, std::size_t i, std::size_t known, double period) {
  if (elapsed(rows, i - 1, i) < 1.5 * period) return std::nullopt;
  double before = lateness(rows, i, i - 1, period);
  for (std::size_t k = std::max(known, i - std::min(i, kWindow)); k < i; ++k) {
    before = std::min(before, lateness(rows, i, k, period));
  }
  double after = 0.0;
  for (std::size_t k = i; k < std::min(rows.size(), i + kWindow); ++k) {
    after = std::min(after, lateness(rows, i, k, period));
  }
  const double periods = (after - before) / period;
  if (periods < 0.5) return std::nullopt;
  return RowGap{i, std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::llround(periods))),
                Evidence::kTime};
}

}  // namespace

std::string_view word(Evidence evidence) {
  switch (evidence) {
    case Evidence::kCounter:
      return "counter";
    case Evidence::kDuplicate:
      return "duplicate";
    case Evidence::kTime:
      return "time";
    case Evidence::kFlag:
      break;
  }
  return "flag";
}

double typical_period(const v1::RecordedStream& stream, const Rows& rows) {
  const double nominal = 1e9 / stream.rate_hz();
  if (rows.size() <= 2 * kWindow) return nominal;
  std::vector<double> lags;
  lags.reserve(rows.size() - kWindow);
  for (std::size_t i = kWindow; i < rows.size(); ++i) lags.push_back(elapsed(rows, i - kWindow, i));
  const auto middle = lags.begin() + static_cast<std::ptrdiff_t>(lags.size() / 2);
  std::nth_element(lags.begin(), middle, lags.end());
  const double period = *middle / static_cast<double>(kWindow);
  return period > 0.0 ? period : nominal;
}

std::vector<RowGap> find_gaps(const v1::RecordedStream& stream, const Rows& rows) {
  std::vector<RowGap> out;
  const double period = typical_period(stream, rows);
  const bool counts = stream.counter_modulus() != 0;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    std::optional<RowGap> gap =
        counts ? counter_gap(stream, rows, i, period)
               : time_gap(rows, i, out.empty() ? 0 : out.back().before, period);
    if (!gap && (rows.flags[i] & kLostBefore) != 0) gap = RowGap{i, 0, Evidence::kFlag};
    if (gap) out.push_back(*gap);
  }
  return out;
}

std::vector<Part> parts_between(const std::vector<RowGap>& gaps, std::size_t rows) {
  std::vector<Part> out;
  std::size_t begin = 0;
  for (const RowGap& gap : gaps) {
    out.push_back({begin, gap.before - begin});
    begin = gap.before;
  }
  if (rows > begin) out.push_back({begin, rows - begin});
  return out;
}

}  // namespace imunoise::recording
