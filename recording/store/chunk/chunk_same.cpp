#include <algorithm>
#include <cstring>

#include "recording/store/chunk/chunk.h"

namespace imunoise::recording {
namespace {

// Bit by bit: a NaN is the same as itself.
template <class Number>
bool same(const std::vector<Number>& a, const std::vector<Number>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Number)) == 0);
}

bool same(const Numbers& a, const Numbers& b) {
  if (a.index() != b.index()) return false;
  return std::visit(
      [&](const auto& values) { return same(values, std::get<std::decay_t<decltype(values)>>(b)); },
      a);
}

bool same(const Rows& a, const Rows& b) {
  return same(a.host_time, b.host_time) && same(a.counter, b.counter) && same(a.flags, b.flags) &&
         a.received == b.received && refused_rows(a.refused) == refused_rows(b.refused) &&
         std::equal(a.channels.begin(), a.channels.end(), b.channels.begin(), b.channels.end(),
                    [](const Numbers& x, const Numbers& y) { return same(x, y); });
}

bool same(const v1::RecordedChannel& a, const v1::RecordedChannel& b) {
  return a.name() == b.name() && a.scale_factor() == b.scale_factor() &&
         a.add_offset() == b.add_offset();
}

bool same(const v1::RecordedStream& a, const v1::RecordedStream& b) {
  return a.name() == b.name() && a.counter_modulus() == b.counter_modulus() &&
         a.counter_step() == b.counter_step() &&
         std::equal(a.channels().begin(), a.channels().end(), b.channels().begin(),
                    b.channels().end(), [](const auto& x, const auto& y) { return same(x, y); });
}

}  // namespace

bool same_samples(const Chunk& a, const Chunk& b) {
  const auto& x = a.device.streams();
  const auto& y = b.device.streams();
  return a.replicate == b.replicate && a.first_sequence == b.first_sequence &&
         a.last_sequence == b.last_sequence &&
         std::equal(x.begin(), x.end(), y.begin(), y.end(),
                    [](const auto& s, const auto& t) { return same(s, t); }) &&
         std::equal(a.streams.begin(), a.streams.end(), b.streams.begin(), b.streams.end(),
                    [](const Rows& s, const Rows& t) { return same(s, t); });
}

}  // namespace imunoise::recording
