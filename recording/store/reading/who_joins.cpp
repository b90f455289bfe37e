#include "recording/store/reading/who_joins.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "recording/import/import.h"

namespace imunoise::recording {
namespace {

constexpr double kWholeRatio = 1e-3;   // as rates of one import may differ
constexpr double kMostPpm = 30'000.0;  // what data sheets of free oscillators admit
constexpr double kKeptShare = 0.5;     // of the others' time, that one more must leave them

std::optional<std::size_t> whole_ratio(Hertz rate, Hertz base) {
  const double ratio = rate.value / base.value;
  const double whole = std::round(ratio);
  if (whole < 1.0 || std::abs(ratio / whole - 1.0) > kWholeRatio) return std::nullopt;
  return static_cast<std::size_t>(whole);
}

std::vector<Joining> of_rate(const std::vector<Joining>& streams, Hertz base) {
  std::vector<Joining> out;
  for (const Joining& one : streams) {
    if (const auto averaged = whole_ratio(one.stream->rate, base))
      out.push_back({one.stream, *averaged});
  }
  return out;
}

std::string unfit(const DeviceStream& stream) {
  if (!stream.defect.empty()) return stream.defect;
  if (seconds_of({{&stream, 1}}) == 0.0) return "no stretch without a gap has ten seconds";
  const double ppm = clock_ppm(stream);
  if (std::abs(ppm) <= kMostPpm) return {};
  return fmt::format("it samples {:.1f} % {} than its nominal rate, by the host's clock",
                     std::abs(ppm) * 1e-4, ppm > 0.0 ? "faster" : "slower");
}

bool among(const std::vector<Joining>& streams, const Joining& one) {
  return std::any_of(streams.begin(), streams.end(),
                     [&](const Joining& other) { return other.stream == one.stream; });
}

// The rate that most devices go with; of equals the highest, which keeps the shortest times.
WhoJoins largest_group(const std::vector<Joining>& streams) {
  WhoJoins out;
  for (const Joining& one : streams) {
    std::vector<Joining> with = of_rate(streams, one.stream->rate);
    const auto better = std::pair(devices_of(with), one.stream->rate.value);
    if (!out.joined.empty() && better <= std::pair(devices_of(out.joined), out.rate.value))
      continue;
    out.rate = one.stream->rate;
    out.joined = std::move(with);
  }
  return out;
}

std::vector<WhoJoins> groups_of(std::vector<Joining> streams) {
  std::vector<WhoJoins> out{largest_group(streams)};
  const std::vector<Joining> first = out.front().joined;
  std::erase_if(streams, [&](const Joining& one) { return among(first, one); });
  for (const Joining& one : streams) {
    out.front().left_out.push_back(
        {one.stream, fmt::format("rates differ: {:.6g} Hz and {:.6g} Hz have no whole ratio",
                                 one.stream->rate.value, out.front().rate.value)});
  }
  while (devices_of(streams) > 1) {
    WhoJoins next = largest_group(streams);
    if (devices_of(next.joined) < 2) break;
    std::erase_if(streams, [&](const Joining& one) { return among(next.joined, one); });
    out.push_back(std::move(next));
  }
  return out;
}

// One after the other, the longest first.
void keep_by_time(WhoJoins& who) {
  std::vector<Joining> order = who.joined;
  std::stable_sort(order.begin(), order.end(), [](const Joining& a, const Joining& b) {
    return seconds_of({a}) > seconds_of({b});
  });
  const double least = static_cast<double>(kMinimumSamples) / who.rate.value;
  std::vector<Joining> in;
  double together = 0.0;
  for (const Joining& one : order) {
    std::vector<Joining> with = in;
    with.push_back(one);
    const double seconds = seconds_of(with);
    if (!in.empty() && seconds < least) {
      who.left_out.push_back(
          {one.stream, fmt::format("it never ran at the same time as {}",
                                   in.size() > 1 ? "the others" : in[0].stream->device)});
    } else if (in.size() > 1 && seconds < kKeptShare * together) {
      who.left_out.push_back(
          {one.stream,
           fmt::format("it shares only {:.4g} s of the {:.4g} s that the others have together",
                       seconds, together)});
    } else {
      in = std::move(with);
      together = seconds;
    }
  }
  std::erase_if(who.joined, [&](const Joining& one) { return !among(in, one); });
}

}  // namespace

std::vector<GridStream> in_replicate(const std::vector<Joining>& joined, std::uint32_t replicate) {
  std::vector<GridStream> out;
  for (const Joining& one : joined) {
    const auto found = one.stream->replicates.find(replicate);
    if (found == one.stream->replicates.end()) return {};
    out.push_back({found->second.timelines, one.averaged});
  }
  return out;
}

double clock_ppm(const DeviceStream& stream) {
  double sum = 0.0;
  double samples = 0.0;
  for (const auto& [number, replicate] : stream.replicates) {
    for (const Timeline& line : replicate.timelines) {
      const auto count = static_cast<double>(line.part.count);
      sum += count * (1.0 - line.period_ns * 1e-9 * stream.rate.value);
      samples += count;
    }
  }
  return 1e6 * sum / samples;
}

double seconds_of(const std::vector<Joining>& joined) {
  double out = 0.0;
  for (const auto& [number, replicate] : joined.front().stream->replicates) {
    const std::vector<GridStream> streams = in_replicate(joined, number);
    if (!streams.empty()) out += seconds_together(streams);
  }
  return out;
}

std::size_t devices_of(const std::vector<Joining>& joined) {
  std::set<std::string> names;
  for (const Joining& one : joined) names.insert(one.stream->device);
  return names.size();
}

std::vector<WhoJoins> who_joins(const std::vector<DeviceStream>& streams) {
  std::vector<Joining> fit;
  std::vector<Staying> left_out;
  for (const DeviceStream& one : streams) {
    if (std::string reason = unfit(one); !reason.empty()) {
      left_out.push_back({&one, std::move(reason)});
    } else {
      fit.push_back({&one, 1});
    }
  }
  std::vector<WhoJoins> out = groups_of(std::move(fit));
  std::vector<Staying>& told = out.front().left_out;
  told.insert(told.begin(), left_out.begin(), left_out.end());
  for (WhoJoins& one : out) keep_by_time(one);
  return out;
}

}  // namespace imunoise::recording
