#include "recording/store/who_joins.h"

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

class Choice {
 public:
  explicit Choice(const std::vector<DeviceStream>& streams) {
    for (const DeviceStream& one : streams) {
      if (const std::string reason = unfit(one); !reason.empty()) {
        leave_out(one, reason);
      } else {
        out_.joined.push_back({&one, 1});
      }
    }
  }

  // The rate that most devices go with; of equals the highest, which keeps the shortest times.
  void by_rate() {
    if (out_.joined.empty()) return;
    std::vector<Joining> best;
    for (const Joining& one : out_.joined) {
      std::vector<Joining> with = of_rate(out_.joined, one.stream->rate);
      const auto better = std::pair(devices_of(with), one.stream->rate.value);
      if (!best.empty() && better <= std::pair(devices_of(best), out_.rate.value)) continue;
      out_.rate = one.stream->rate;
      best = std::move(with);
    }
    for (const Joining& one : out_.joined) {
      if (whole_ratio(one.stream->rate, out_.rate)) continue;
      leave_out(*one.stream,
                fmt::format("rates differ: {:.6g} Hz and {:.6g} Hz have no whole ratio",
                            one.stream->rate.value, out_.rate.value));
    }
    out_.joined = std::move(best);
  }

  // One after the other, the longest first.
  void by_time() {
    std::vector<Joining> order = out_.joined;
    std::stable_sort(order.begin(), order.end(), [](const Joining& a, const Joining& b) {
      return seconds_of({a}) > seconds_of({b});
    });
    const double least = static_cast<double>(kMinimumSamples) / out_.rate.value;
    std::vector<Joining> in;
    double together = 0.0;
    for (const Joining& one : order) {
      std::vector<Joining> with = in;
      with.push_back(one);
      const double seconds = seconds_of(with);
      if (!in.empty() && seconds < least) {
        leave_out(*one.stream, fmt::format("it has no time in common with {}",
                                           in.size() > 1 ? "the others" : in[0].stream->device));
      } else if (in.size() > 1 && seconds < kKeptShare * together) {
        leave_out(
            *one.stream,
            fmt::format("it shares only {:.4g} s of the {:.4g} s that the others have together",
                        seconds, together));
      } else {
        in = std::move(with);
        together = seconds;
      }
    }
    std::erase_if(out_.joined, [&](const Joining& one) {
      return std::none_of(in.begin(), in.end(),
                          [&](const Joining& kept) { return kept.stream == one.stream; });
    });
  }

  WhoJoins take() { return std::move(out_); }

 private:
  static std::string unfit(const DeviceStream& stream) {
    if (!stream.defect.empty()) return stream.defect;
    if (seconds_of({{&stream, 1}}) == 0.0) return "no stretch without a gap has ten seconds";
    const double ppm = clock_ppm(stream);
    if (std::abs(ppm) <= kMostPpm) return {};
    return fmt::format("it samples {:.1f} % {} than it says, by the host's clock",
                       std::abs(ppm) * 1e-4, ppm > 0.0 ? "faster" : "slower");
  }

  void leave_out(const DeviceStream& stream, const std::string& reason) {
    out_.left_out.push_back({stream.device, stream.stream, "not joined: " + reason});
  }

  WhoJoins out_;
};

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

WhoJoins who_joins(const std::vector<DeviceStream>& streams) {
  Choice choice(streams);
  choice.by_rate();
  choice.by_time();
  return choice.take();
}

}  // namespace imunoise::recording
