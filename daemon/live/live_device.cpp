#include "daemon/live/live_device.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <variant>

#include "core/support/counted.h"
#include "core/support/distributions.h"
#include "core/support/units.h"
#include "daemon/config/quantity_text.h"

namespace imunoise::live {
namespace {

constexpr std::int64_t kStuckAfter = 60'000'000'000;  // ns
constexpr double kWarming = 2.0 / 3600.0;             // K/s

// "once", "3 times".
std::string times(std::size_t count) {
  return count == 1 ? "once" : fmt::format("{} times", count);
}

std::string rejected_words(const Concern& of) {
  return fmt::format("{} rejected", counted(of.count(), "sample"));
}

std::string lost_words(const Concern& of) {
  return fmt::format("samples missing {}", times(of.count()));
}

double number_at(const recording::Numbers& numbers, std::size_t i) {
  return std::visit([i](const auto& values) { return static_cast<double>(values[i]); }, numbers);
}

// The numbers at and beyond which a sensor saturates: stated, or the type's own.
bool at_the_end(const v1::RecordedChannel& channel, double number) {
  const bool small = channel.dtype() == "<i2";
  const double least = channel.has_valid_min() ? channel.valid_min() : small ? -32768.0 : -INFINITY;
  const double most = channel.has_valid_max() ? channel.valid_max() : small ? 32767.0 : INFINITY;
  return number <= least || number >= most;
}

v1::LiveScale describe(const KnownScale& scale) {
  v1::LiveScale out;
  out.set_tau_s(scale.tau_s);
  out.set_deviation(std::sqrt(scale.variance));
  out.set_degrees_of_freedom(scale.degrees);
  const double sum = scale.degrees * scale.variance;
  out.set_lower(std::sqrt(sum / chi_square_quantile(0.975, scale.degrees)));
  out.set_upper(std::sqrt(sum / chi_square_quantile(0.025, scale.degrees)));
  // Each further τ brings one more.
  out.set_enough_in_s(std::max(0.0, (kEnoughDegrees - scale.degrees) * scale.tau_s));
  return out;
}

// The averaging times that every channel knows well enough, and what the next powers of ten take.
std::string outlook(const v1::LiveDevice& state) {
  constexpr int kAhead = 3;
  double known = INFINITY;
  for (const v1::LiveChannel& channel : state.channels()) {
    double of_channel = 0.0;
    for (const v1::LiveScale& scale : channel.scales()) {
      if (scale.enough_in_s() > 0.0) break;
      of_channel = scale.tau_s();
    }
    known = std::min(known, of_channel);
  }
  if (state.channels().empty()) return "";
  std::string out = known > 0.0 ? fmt::format(
                                      "averaging times up to {:.3g} s are known within a "
                                      "factor of two",
                                      known)
                                : "no averaging time is known within a factor of two";
  int told = 0;
  for (double tau = 1.0; told < kAhead; tau *= 10.0) {
    if (tau <= known) continue;
    const double left = std::max(0.0, (kEnoughDegrees + 1.0) * tau - state.elapsed_s());
    out += fmt::format("{} {:.0f} s in {}", told++ == 0 ? ";" : ",", tau,
                       config::print_duration(std::ceil(left)));
  }
  return out;
}

}  // namespace

std::optional<LiveDevice::Pictured> LiveDevice::pictured_of(const v1::RecordedDevice& device) {
  const auto rank = [](Quantity quantity) {
    if (quantity == Quantity::kAngularRate) return 0;
    return quantity == Quantity::kAcceleration ? 1 : 2;
  };
  std::optional<Pictured> out;
  int best = 3;
  for (int s = 0; s < device.streams_size(); ++s) {
    const v1::RecordedStream& stream = device.streams(s);
    if (!(stream.rate_hz() > 0.0)) continue;
    for (int c = 0; c < stream.channels_size(); ++c) {
      const int of = rank(recording::units_of(stream.channels(c)).quantity);
      if (of >= best) continue;
      best = of;
      out = Pictured{static_cast<std::size_t>(s), static_cast<std::size_t>(c)};
    }
  }
  return out;
}

LiveDevice::LiveDevice(const v1::RecordedDevice& device)
    : device_(device), pictured_(pictured_of(device)) {
  for (const v1::RecordedStream& stream : device.streams()) {
    Stream& to = streams_.emplace_back(stream);
    for (int c = 0; c < stream.channels_size(); ++c) {
      const recording::ChannelUnits known = recording::units_of(stream.channels(c));
      const auto index = static_cast<std::size_t>(c);
      if (known.quantity == Quantity::kTemperature) {
        to.warmths.push_back({index, known, {}, {}});
      } else if (of_inertia(known.quantity) && stream.rate_hz() > 0.0) {
        to.channels.push_back({index, {Hertz{stream.rate_hz()}, known.scale}, 0.0, 0, {}});
      }
    }
  }
}

void LiveDevice::take(const recording::Block& block, Steady::time_point now) {
  Stream& to = streams_[block.stream];
  const recording::Rows& rows = block.rows;
  const std::uint64_t refused = recording::refused_rows(rows.refused);
  to.refused += refused;
  if (refused > 0) to.rejected.see(rows.size() > 0 ? rows.host_time.back() : to.now_ns, refused);
  if (rows.size() == 0) return;
  const v1::RecordedStream& stream = device_.streams(static_cast<int>(block.stream));
  take_gaps(rows, stream.rate_hz(), to);
  to.rings.take(rows);
  for (Channel& channel : to.channels) take_channel(rows, stream, channel);
  for (Warmth& one : to.warmths) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double number = number_at(rows.channels[one.index], i);
      if (!std::isfinite(number)) continue;
      one.newest = one.units.value(number);
      one.slope.take(rows.host_time[i], *one.newest);
    }
  }
  if (!to.begin_ns) to.begin_ns = rows.host_time.front();
  to.now_ns = rows.host_time.back();
  to.samples += rows.size();
  to.rate.take(to.now_ns, to.samples);
  to.heard = now;
}

// How many are missing follows from the time stamps.
void LiveDevice::take_gaps(const recording::Rows& rows, double rate_hz, Stream& to) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if ((rows.flags[i] & recording::kLostBefore) == 0 || to.samples + i == 0) continue;
    ++to.gaps;
    to.lost.see(rows.host_time[i]);
    const std::int64_t before = i > 0 ? rows.host_time[i - 1] : to.now_ns;
    const double steps = 1e-9 * static_cast<double>(rows.host_time[i] - before) * rate_hz;
    to.missing += static_cast<std::uint64_t>(std::max(0.0, std::round(steps - 1.0)));
  }
}

void LiveDevice::take_channel(const recording::Rows& rows, const v1::RecordedStream& stream,
                              Channel& to) {
  const v1::RecordedChannel& channel = stream.channels(static_cast<int>(to.index));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double number = number_at(rows.channels[to.index], i);
    if ((rows.flags[i] & recording::kLostBefore) != 0) to.variance.gap();
    if (std::isfinite(number)) to.variance.push(number);
    if (at_the_end(channel, number)) to.saturated.see(rows.host_time[i]);
    if (number != to.last || to.same_since_ns == 0) to.same_since_ns = rows.host_time[i];
    to.last = number;
  }
}

// For how many seconds no samples have come; 0: they come, or need not.
double LiveDevice::silence(const v1::RecordedStream& stream, const Stream& of,
                           Steady::time_point now) {
  constexpr double kLeast = 3.0;     // s: more than a device or its bridge keeps back
  constexpr double kSamples = 20.0;  // of a slow stream
  if (!of.begin_ns || !(stream.rate_hz() > 0.0)) return 0.0;
  const double out = std::chrono::duration<double>(now - of.heard).count();
  return out > std::max(kLeast, kSamples / stream.rate_hz()) ? out : 0.0;
}

v1::LiveStream LiveDevice::describe(const v1::RecordedStream& stream, const Stream& of,
                                    Steady::time_point now) {
  const double silent_s = silence(stream, of, now);
  v1::LiveStream out;
  out.set_stream(stream.name());
  out.set_nominal_hz(stream.rate_hz());
  if (const auto rate = of.rate.hz()) out.set_rate_hz(silent_s > 0.0 ? 0.0 : *rate);
  out.set_samples(of.samples);
  out.set_missing(of.missing + static_cast<std::uint64_t>(silent_s * stream.rate_hz()));
  out.set_gaps(of.gaps);
  out.set_refused(of.refused);
  if (!of.warmths.empty() && of.warmths.front().newest)
    out.set_temperature_k(*of.warmths.front().newest);
  return out;
}

v1::LiveChannel LiveDevice::describe(const v1::RecordedStream& stream, const Channel& channel) {
  const v1::RecordedChannel& recorded = stream.channels(static_cast<int>(channel.index));
  v1::LiveChannel out;
  out.set_stream(stream.name());
  out.set_channel(recorded.name());
  out.set_units(recording::units_of(recorded).symbol);
  for (const KnownScale& scale : channel.variance.known())
    *out.add_scales() = live::describe(scale);
  return out;
}

void LiveDevice::warn(const v1::RecordedStream& stream, const Stream& of, Steady::time_point now,
                      std::vector<v1::LiveWarning>& to) {
  const auto add = [&](v1::LiveConcern concern, const std::string& channel, std::int64_t since,
                       const std::string& sentence) {
    v1::LiveWarning& out = to.emplace_back();
    out.set_concern(concern);
    out.set_stream(stream.name());
    out.set_channel(channel);
    out.set_since_ns(since);
    out.set_sentence(fmt::format("{}: {}", channel.empty() ? stream.name() : channel, sentence));
  };
  const auto name = [&](std::size_t index) -> const std::string& {
    return stream.channels(static_cast<int>(index)).name();
  };
  if (const double seconds = silence(stream, of, now); seconds > 0.0)
    add(v1::silent, "", of.now_ns, fmt::format("no samples for {:.0f} s", seconds));
  const auto rejected = of.rejected.since(of.now_ns);
  const auto lost = of.lost.since(of.now_ns);
  if (rejected || lost) {
    std::vector<std::string> what;
    if (rejected) what.push_back(rejected_words(of.rejected));
    if (lost) what.push_back(lost_words(of.lost));
    add(v1::lost_samples, "", std::min(rejected.value_or(INT64_MAX), lost.value_or(INT64_MAX)),
        fmt::format("{} in the last minutes", fmt::join(what, ", ")));
  }
  for (const Channel& one : of.channels) {
    if (const auto since = one.saturated.since(of.now_ns)) {
      add(v1::saturated, name(one.index), *since,
          fmt::format("{} at the limit of the range", counted(one.saturated.count(), "sample")));
    }
    if (of.now_ns - one.same_since_ns > kStuckAfter) {
      add(v1::stuck, name(one.index), one.same_since_ns,
          fmt::format("has been {} for {:.0f} s", one.last,
                      static_cast<double>(of.now_ns - one.same_since_ns) * 1e-9));
    }
  }
  for (const Warmth& one : of.warmths) {
    const auto slope = one.slope.per_second();
    if (!slope || std::abs(*slope) < kWarming) continue;
    add(v1::warming, name(one.index), *of.begin_ns,
        fmt::format("the temperature {} by {:.1f} K an hour; let it settle",
                    *slope > 0.0 ? "rises" : "falls", std::abs(*slope) * 3600.0));
  }
}

v1::LiveDevice LiveDevice::state(Steady::time_point now) const {
  v1::LiveDevice out;
  out.set_device(device_.name());
  for (std::size_t s = 0; s < streams_.size(); ++s) {
    const Stream& of = streams_[s];
    const v1::RecordedStream& stream = device_.streams(static_cast<int>(s));
    out.set_samples(out.samples() + of.samples);
    out.set_refused(out.refused() + of.refused);
    out.set_gaps(out.gaps() + of.gaps);
    *out.add_streams() = describe(stream, of, now);
    if (!of.begin_ns) continue;
    out.set_last_sample_ns(std::max(out.last_sample_ns(), of.now_ns));
    const double elapsed = static_cast<double>(of.now_ns - *of.begin_ns) * 1e-9;
    out.set_elapsed_s(std::max(out.elapsed_s(), elapsed));
    for (const Channel& channel : of.channels) *out.add_channels() = describe(stream, channel);
  }
  out.set_outlook(outlook(out));
  for (v1::LiveWarning& one : warnings(now)) *out.add_warnings() = std::move(one);
  if (v1::LiveWarning past = past_warning(); past.since_ns() != 0)
    *out.mutable_past_warning() = std::move(past);
  if (pictured_) {
    const double rate = device_.streams(static_cast<int>(pictured_->stream)).rate_hz();
    *out.mutable_last_minute() =
        streams_[pictured_->stream].rings.last_minute(pictured_->channel, rate);
  }
  return out;
}

// Without a time where nothing was of concern and is no more.
v1::LiveWarning LiveDevice::past_warning() const {
  v1::LiveWarning out;
  const auto see = [&](v1::LiveConcern concern, const Concern& of, const Stream& stream,
                       const std::string& sentence) {
    if (of.count() == 0 || of.since(stream.now_ns) || of.last_ns() <= out.since_ns()) return;
    out.set_concern(concern);
    out.set_since_ns(of.last_ns());
    out.set_sentence(sentence);
  };
  for (std::size_t s = 0; s < streams_.size(); ++s) {
    const v1::RecordedStream& stream = device_.streams(static_cast<int>(s));
    const Stream& of = streams_[s];
    see(v1::lost_samples, of.rejected, of,
        fmt::format("{}: {}", stream.name(), rejected_words(of.rejected)));
    see(v1::lost_samples, of.lost, of, fmt::format("{}: {}", stream.name(), lost_words(of.lost)));
    for (const Channel& one : of.channels) {
      see(v1::saturated, one.saturated, of,
          fmt::format("{}: {} at the limit of the range",
                      stream.channels(static_cast<int>(one.index)).name(),
                      counted(one.saturated.count(), "sample")));
    }
  }
  return out;
}

Result<v1::SampleRanges> LiveDevice::samples(const v1::GetLiveSamplesRequest& request) const {
  for (std::size_t s = 0; s < streams_.size(); ++s) {
    const std::string& name = device_.streams(static_cast<int>(s)).name();
    if (!request.stream().empty() && request.stream() != name) continue;
    auto out = streams_[s].rings.ranges(request.samples_each(), request.from(),
                                        {request.channel().begin(), request.channel().end()});
    if (!out) return out;
    out->set_stream(name);
    if (streams_[s].begin_ns)
      out->set_length_s(1e-9 * static_cast<double>(streams_[s].now_ns - *streams_[s].begin_ns));
    return out;
  }
  return fail(fmt::format("stream '{}': device '{}' has none", request.stream(), name()));
}

std::vector<v1::LiveWarning> LiveDevice::warnings(Steady::time_point now) const {
  std::vector<v1::LiveWarning> out;
  for (std::size_t s = 0; s < streams_.size(); ++s) {
    if (streams_[s].begin_ns) warn(device_.streams(static_cast<int>(s)), streams_[s], now, out);
  }
  return out;
}

}  // namespace imunoise::live
