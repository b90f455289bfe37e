#include "recording/import/table/streams.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>

#include "recording/import/table/names.h"
#include "recording/import/table/select.h"

namespace imunoise::recording {
namespace {

constexpr double kSameRate = 0.01;
constexpr double kEnough = 0.9;  // of the rows that have a partner

// ns. Times of a damaged file may lie further apart than int64 can say: they wrap.
double between(std::int64_t begin, std::int64_t end) {
  return static_cast<double>(static_cast<std::int64_t>(static_cast<std::uint64_t>(end) -
                                                       static_cast<std::uint64_t>(begin)));
}

// ns; of most samples: gaps and bursts hardly change it.
double usual_step(const TimedStream& one) {
  const std::size_t count = one.times.size();
  if (count < 2) return 0.0;
  const std::size_t stride = std::max<std::size_t>(1, count / 8192);
  std::vector<double> steps;
  for (std::size_t i = 1; i < count; i += stride)
    steps.push_back(between(one.times[i - 1], one.times[i]));
  std::vector<double> sorted = steps;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  double sum = 0.0;
  double usual = 0.0;
  for (const double step : steps) {
    if (std::abs(step - *middle) > 0.5 * *middle) continue;
    sum += step;
    usual += 1.0;
  }
  return usual > 0.0 ? sum / usual : *middle;
}

bool has_rates(const TimedStream& one) {
  return std::any_of(one.columns.begin(), one.columns.end(), [](const Column& column) {
    return role_of(column.name).quantity == Quantity::kAngularRate;
  });
}

bool is_inertial(const TimedStream& one) {
  return std::any_of(one.columns.begin(), one.columns.end(), [](const Column& column) {
    const Quantity quantity = role_of(column.name).quantity;
    return quantity == Quantity::kAngularRate || quantity == Quantity::kAcceleration;
  });
}

bool has_channel(const TimedStream& one, const std::string& wanted) {
  return std::any_of(one.columns.begin(), one.columns.end(), [&](const Column& column) {
    return column.name == wanted || matches(wanted, column.name);
  });
}

// How much later than `first` the samples of `second` usually come (ns), within half a step: the
// mean direction on a circle of one step.
double usual_delay(const std::vector<std::int64_t>& first, const std::vector<std::int64_t>& second,
                   double step) {
  double sine = 0.0;
  double cosine = 0.0;
  std::size_t at = 0;
  const std::size_t stride = std::max<std::size_t>(1, first.size() / 4096);
  for (std::size_t i = 0; i < first.size(); i += stride) {
    while (at < second.size() && second[at] < first[i]) ++at;
    if (at == second.size()) break;
    const double turn = 2.0 * std::numbers::pi * between(first[i], second[at]) / step;
    sine += std::sin(turn);
    cosine += std::cos(turn);
  }
  return step * std::atan2(sine, cosine) / (2.0 * std::numbers::pi);
}

using Row = std::uint32_t;
constexpr Row kAlone = std::numeric_limits<Row>::max();

// For each row of `first` the sample of `second` that belongs to it.
std::vector<Row> partners(const std::vector<std::int64_t>& first,
                          const std::vector<std::int64_t>& second, double step) {
  const double delay = usual_delay(first, second, step);
  std::vector<Row> out(first.size(), kAlone);
  if (second.size() >= kAlone) return out;
  Row at = 0;
  const auto away = [&](std::size_t i, Row j) {
    return std::abs(between(first[i], second[j]) - delay);
  };
  for (std::size_t i = 0; i < first.size() && at < second.size(); ++i) {
    while (at + 1 < second.size() && away(i, at + 1) <= away(i, at)) ++at;
    if (away(i, at) > 0.5 * step) continue;
    out[i] = at;
    if (i > 0 && out[i - 1] == at) out[i] = kAlone;
  }
  return out;
}

Result<std::size_t> main_stream(const std::string& file, const std::vector<TimedStream>& streams,
                                const ImportOptions& options) {
  std::string all;
  for (const TimedStream& one : streams) all += (all.empty() ? "" : ", ") + one.name;
  const auto find = [&](auto&& good) {
    return static_cast<std::size_t>(std::find_if(streams.begin(), streams.end(), good) -
                                    streams.begin());
  };
  std::size_t found = 0;
  if (!options.topic.empty()) {
    found = find([&](const TimedStream& one) { return one.name == options.topic; });
    if (found < streams.size()) return found;
    return fail(fmt::format("{}: no topic '{}' with samples (it has: {}); choose with --topic",
                            file, options.topic, all));
  }
  if (!options.channels.empty()) {
    found = find([&](const TimedStream& one) { return has_channel(one, options.channels[0]); });
    if (found < streams.size()) return found;
  }
  found = find(has_rates);
  if (found < streams.size()) return found;
  return static_cast<std::size_t>(std::max_element(streams.begin(), streams.end(),
                                                   [](const TimedStream& a, const TimedStream& b) {
                                                     return a.times.size() < b.times.size();
                                                   }) -
                                  streams.begin());
}

// Values by the rows that they belong to; in place where none has to go to a later row, as of two
// topics that began together.
void put_at_partners(const std::vector<Row>& partner, std::vector<double>& values) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  bool in_place = partner.size() <= values.size();
  for (std::size_t i = 0; i < partner.size() && in_place; ++i)
    in_place = partner[i] == kAlone || partner[i] >= i;
  std::vector<double> apart(in_place ? 0 : partner.size());
  std::vector<double>& out = in_place ? values : apart;
  for (std::size_t i = 0; i < partner.size(); ++i)
    out[i] = partner[i] == kAlone ? none : values[partner[i]];
  if (in_place)
    values.resize(partner.size());
  else
    values = std::move(apart);
}

// Adds the columns of `other` to `to`. False: it has another rate.
bool joined(TimedStream& to, TimedStream& other) {
  const double step = usual_step(to);
  const double other_step = usual_step(other);
  if (!(step > 0.0) || !(std::abs(other_step / step - 1.0) < kSameRate)) return false;
  const std::vector<Row> partner = partners(to.times, other.times, step);
  other.times = {};
  const auto there =
      partner.size() - static_cast<std::size_t>(std::count(partner.begin(), partner.end(), kAlone));
  if (static_cast<double>(there) < kEnough * static_cast<double>(partner.size())) return false;
  for (Column& column : other.columns) {
    put_at_partners(partner, std::get<std::vector<double>>(column.samples));
    to.columns.push_back(std::move(column));
  }
  return true;
}

}  // namespace

Result<Table> join_streams(const std::string& file, std::vector<TimedStream> streams,
                           const std::string& time_name, const ImportOptions& options,
                           std::string_view kind) {
  std::erase_if(streams, [](const TimedStream& one) { return one.times.empty(); });
  if (streams.empty()) return fail(fmt::format("{}: holds no samples of a sensor", file));
  const Result<std::size_t> chosen = main_stream(file, streams, options);
  if (!chosen) return tl::make_unexpected(chosen.error());
  Table table;
  TimedStream& first = streams[*chosen];
  std::string names = first.name;
  for (std::size_t s = 0; s < streams.size(); ++s) {
    if (s == *chosen) continue;
    TimedStream& other = streams[s];
    const double rate = usual_step(other) > 0.0 ? 1e9 / usual_step(other) : 0.0;
    if (options.topic.empty() && joined(first, other)) {
      names += ", " + other.name;
    } else {
      table.notes.push_back(fmt::format("{} {} ({:.4g} Hz) is left out: read it with --{} {}", kind,
                                        other.name, rate, kind, other.name));
      if (options.topic.empty() && is_inertial(other))
        table.others.push_back({other.name, kind == "topic"});
    }
  }
  table.notes.insert(table.notes.begin(), fmt::format("{} {}", kind, names));
  std::vector<Offer> offers;
  for (const Column& one : first.columns) {
    const bool known = one.unit.empty() || parse_unit(one.unit);
    offers.push_back({one.name, known, one.unit});
  }
  const auto wanted = select_columns(file, offers, options);
  if (!wanted) return tl::make_unexpected(wanted.error());
  for (const std::size_t c : *wanted) table.columns.push_back(std::move(first.columns[c]));
  if (!options.rate) table.time = TimeColumn{time_name, "ns", std::move(first.times)};
  table.row = [](std::size_t i) { return fmt::format("sample {}", i); };
  return table;
}

}  // namespace imunoise::recording
