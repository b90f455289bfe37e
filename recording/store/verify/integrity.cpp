#include "recording/store/verify/integrity.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace imunoise::recording {
namespace {

constexpr int kShownGaps = 100;
constexpr double kByChance = 1e-6;

struct Limits {
  double low;
  double high;
};

// Stored numbers at and beyond which a channel saturates; an integer type has its own ends.
template <class Number>
Limits limits(const v1::RecordedChannel& channel) {
  constexpr bool counts = std::is_integral_v<Number>;
  constexpr double far = std::numeric_limits<double>::infinity();
  const double low = counts ? static_cast<double>(std::numeric_limits<Number>::min()) : -far;
  const double high = counts ? static_cast<double>(std::numeric_limits<Number>::max()) : far;
  return {channel.has_valid_min() ? channel.valid_min() : low,
          channel.has_valid_max() ? channel.valid_max() : high};
}

template <class Number>
void check_numbers(const v1::RecordedChannel& channel, const std::vector<Number>& values,
                   v1::ChannelIntegrity& out) {
  const Limits limit = limits<Number>(channel);
  std::uint64_t saturated = 0;
  std::size_t equal_neighbours = 0;
  std::size_t run_begin = 0;
  std::size_t longest = 0;
  std::size_t longest_at = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto value = static_cast<double>(values[i]);
    saturated += value <= limit.low || value >= limit.high ? 1U : 0U;
    if (i > 0 && values[i] == values[i - 1]) {
      ++equal_neighbours;
    } else {
      run_begin = i;
    }
    if (i - run_begin + 1 > longest) {
      longest = i - run_begin + 1;
      longest_at = run_begin;
    }
  }
  out.set_saturated(saturated);
  out.set_longest_run(longest);
  out.set_longest_run_at(longest_at);
  if (longest < 2) return;
  const auto n = static_cast<double>(values.size());
  // Laplace's rule: a share of equal neighbours that few samples show is not taken for zero.
  const double others = static_cast<double>(equal_neighbours - (longest - 1)) + 1.0;
  const double share = others / (n - static_cast<double>(longest) + 2.0);
  out.set_stuck(share < 1.0 && std::log(n) + static_cast<double>(longest - 1) * std::log(share) <
                                   std::log(kByChance));
}

// Rate and jitter over the longest part, by a straight line through its time stamps.
void check_clock(const Rows& rows, const std::vector<Part>& parts, v1::StreamIntegrity& out) {
  const auto longest = std::max_element(
      parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.count < b.count; });
  if (longest == parts.end() || longest->count < 3) return;
  const auto n = static_cast<double>(longest->count);
  const std::int64_t origin = rows.host_time[longest->begin];
  const auto time = [&](std::size_t i) {  // s since the part's first sample
    return 1e-9 * static_cast<double>(rows.host_time[longest->begin + i] - origin);
  };
  const double middle = (n - 1.0) / 2.0;
  double mean = 0.0;
  for (std::size_t i = 0; i < longest->count; ++i) mean += time(i) / n;
  double slope = 0.0;
  for (std::size_t i = 0; i < longest->count; ++i) {
    slope += (static_cast<double>(i) - middle) * (time(i) - mean);
  }
  slope /= n * (n * n - 1.0) / 12.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < longest->count; ++i) {
    const double off = time(i) - mean - slope * (static_cast<double>(i) - middle);
    squares += off * off;
  }
  if (slope > 0.0) out.set_rate_hz(1.0 / slope);
  out.set_jitter_s(std::sqrt(squares / n));
}

}  // namespace

v1::ChannelIntegrity check_channel(const v1::RecordedChannel& channel, const Numbers& numbers) {
  v1::ChannelIntegrity out;
  out.set_name(channel.name());
  std::visit([&](const auto& values) { check_numbers(channel, values, out); }, numbers);
  return out;
}

v1::StreamIntegrity check_stream(const v1::RecordedStream& stream, const Rows& rows) {
  v1::StreamIntegrity out;
  out.set_stream(stream.name());
  out.set_received(rows.received);
  out.set_stored(rows.size());
  for (const Refusal& one : rows.refused) *out.add_refused() = to_message(one);
  const std::vector<RowGap> gaps = find_gaps(stream, rows);
  out.set_gap_count(gaps.size());
  std::uint64_t gone = 0;
  for (const RowGap& gap : gaps) {
    gone += gap.lost;
    if (gap.evidence == Evidence::kDuplicate) out.set_duplicates(out.duplicates() + 1);
    if (out.gaps_size() >= kShownGaps) continue;
    v1::Gap* const shown = out.add_gaps();
    shown->set_after_sample(gap.before - 1);
    shown->set_lost(gap.lost);
    shown->set_evidence(std::string(word(gap.evidence)));
  }
  // Rows that were refused leave gaps, too, but they came.
  const std::uint64_t refused = rows.received - std::min<std::uint64_t>(rows.received, rows.size());
  out.set_lost(gone - std::min(gone, refused));
  out.set_nominal_rate_hz(stream.rate_hz());
  check_clock(rows, parts_between(gaps, rows.size()), out);
  for (int i = 0; i < stream.channels_size(); ++i) {
    *out.add_channels() =
        check_channel(stream.channels(i), rows.channels[static_cast<std::size_t>(i)]);
  }
  return out;
}

}  // namespace imunoise::recording
