#include "daemon/acquire/stream_clocks.h"

#include <algorithm>
#include <cmath>

#include "drivers/driver.h"

namespace imunoise::acquire {
namespace {

// Samples from one to the next. A counter may have gone round while samples were lost; then the
// host's time tells how often. `modulus` 0 stands for 2^64.
std::uint64_t steps(std::uint64_t from, std::uint64_t to, std::uint64_t modulus, double expected) {
  if (modulus == 0) return to - from;
  const std::uint64_t least = to >= from ? to - from : to + (modulus - from);
  const double rounds =
      std::round((expected - static_cast<double>(least)) / static_cast<double>(modulus));
  return least + static_cast<std::uint64_t>(std::max(0.0, rounds)) * modulus;
}

}  // namespace

void StreamClocks::take(const drivers::SampleBlock& block) {
  const drivers::Stream& stream = block.stream();
  const bool has_time = stream.device_time_tick_s > 0.0;
  const bool has_counter = stream.counter_maximum > 0 && stream.nominal_rate_hz > 0.0;
  if (block.rows() == 0 || (!has_time && !has_counter)) return;
  if (streams_.size() <= block.stream_index()) streams_.resize(block.stream_index() + 1);
  One& to = streams_[block.stream_index()];
  to.stream = stream.name;
  to.from_counter = !has_time;
  if (to.from_counter) return take_counters(block, to);
  const auto flags = block.flags();
  for (std::size_t begin = 0, end = 0; begin < block.rows(); begin = end) {
    if ((flags[begin] & IMUNOISE_SAMPLE_AFTER_RESTART) != 0) to.clock.restart();
    for (end = begin + 1; end < block.rows(); ++end) {
      if ((flags[end] & IMUNOISE_SAMPLE_AFTER_RESTART) != 0) break;
    }
    to.clock.take(block.host_time_ns().subspan(begin, end - begin),
                  block.device_time_ns().subspan(begin, end - begin));
  }
}

void StreamClocks::take_counters(const drivers::SampleBlock& block, One& to) {
  const auto host = block.host_time_ns();
  const auto counter = block.counter();
  const double rate = block.stream().nominal_rate_hz;
  const std::uint64_t modulus = block.stream().counter_maximum + 1;
  for (std::size_t i = 0; i < block.rows(); ++i) {
    if (!to.begun || (block.flags()[i] & IMUNOISE_SAMPLE_AFTER_RESTART) != 0) {
      to.clock.restart();
      to.count = 0;
      to.begun = true;
    } else {
      const double expected = static_cast<double>(host[i] - to.host_ns) * 1e-9 * rate;
      to.count += steps(to.counter, counter[i], modulus, expected);
    }
    to.counter = counter[i];
    to.host_ns = host[i];
    const std::int64_t device = std::llround(static_cast<double>(to.count) / rate * 1e9);
    to.clock.take({&host[i], 1}, {&device, 1});
  }
}

std::vector<v1::ClockComparison> StreamClocks::comparisons(const std::string& device) const {
  std::vector<v1::ClockComparison> out;
  for (const One& one : streams_) {
    auto found = one.clock.comparison();
    if (!found) continue;
    found->set_device(device);
    found->set_stream(one.stream);
    found->set_from_counter(one.from_counter);
    out.push_back(std::move(*found));
  }
  return out;
}

}  // namespace imunoise::acquire
