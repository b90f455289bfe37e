#include "recording/import/table/streams.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
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
    return of_inertia(role_of(column.name).quantity);
  });
}

bool has_channel(const TimedStream& one, const std::string& wanted) {
  return std::any_of(one.columns.begin(), one.columns.end(),
                     [&](const Column& column) { return matches(wanted, column.name); });
}

// How much later than `first` the samples of `second` usually come (ns), within half a step: the
// mean direction on a circle of one step.
double usual_delay(const Times& first, const Times& second, double step) {
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

// Which sample of another stream belongs to each row. Neighbours mostly belong to neighbours: runs
// of them are kept.
class Partners {
 public:
  void add(std::size_t partner) { extend(partner - rows_); }
  void add_none() {
    ++alone_;
    extend(kNone);
  }
  std::size_t rows() const { return rows_; }
  std::size_t alone() const { return alone_; }
  /// Calls `visit` with each row and its partner, or nothing.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      const std::size_t end = r + 1 < runs_.size() ? runs_[r + 1].begin : rows_;
      const std::size_t ahead = runs_[r].ahead;
      for (std::size_t i = runs_[r].begin; i < end; ++i)
        visit(i, ahead == kNone ? std::nullopt : std::optional(i + ahead));
    }
  }
  /// Whether no row's partner comes before the row.
  bool none_behind() const {
    return std::all_of(runs_.begin(), runs_.end(),
                       [](const Run& one) { return one.ahead == kNone || one.ahead < kNone / 2; });
  }

 private:
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max() / 2;
  struct Run {
    std::size_t begin;
    std::size_t ahead;  // of the row; what lies behind wraps
  };
  void extend(std::size_t ahead) {
    if (runs_.empty() || runs_.back().ahead != ahead) runs_.push_back({rows_, ahead});
    ++rows_;
  }

  std::vector<Run> runs_;
  std::size_t rows_ = 0;
  std::size_t alone_ = 0;
};

// For each row of `first` the sample of `second` that belongs to it.
Partners partners(const Times& first, const Times& second, double step) {
  const double delay = usual_delay(first, second, step);
  Partners out;
  std::size_t at = 0;
  std::optional<std::size_t> last;
  const auto away = [&](std::size_t i, std::size_t j) {
    return std::abs(between(first[i], second[j]) - delay);
  };
  for (std::size_t i = 0; i < first.size(); ++i) {
    while (at + 1 < second.size() && away(i, at + 1) <= away(i, at)) ++at;
    const bool near = !(away(i, at) > 0.5 * step) && last != at;
    last = near ? std::optional(at) : std::nullopt;
    if (near)
      out.add(at);
    else
      out.add_none();
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
void put_at_partners(const Partners& partners, std::vector<double>& values) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const bool in_place = partners.rows() <= values.size() && partners.none_behind();
  std::vector<double> apart(in_place ? 0 : partners.rows());
  std::vector<double>& out = in_place ? values : apart;
  partners.for_each([&](std::size_t row, std::optional<std::size_t> partner) {
    out[row] = partner ? values[*partner] : none;
  });
  if (in_place)
    values.resize(partners.rows());
  else
    values = std::move(apart);
}

// Adds the columns of `other` to `to`. False: it has another rate.
bool joined(TimedStream& to, TimedStream& other) {
  const double step = usual_step(to);
  const double other_step = usual_step(other);
  if (!(step > 0.0) || !(std::abs(other_step / step - 1.0) < kSameRate)) return false;
  const Partners found = partners(to.times, other.times, step);
  other.times = {};
  const auto rows = static_cast<double>(found.rows());
  if (rows - static_cast<double>(found.alone()) < kEnough * rows) return false;
  for (Column& column : other.columns) {
    put_at_partners(found, std::get<std::vector<double>>(column.samples));
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
      const bool apart = kind == "sensor";  // no option chooses one
      table.notes.push_back(
          fmt::format("{} {} ({:.4g} Hz) is left out: {}", kind, other.name, rate,
                      apart ? std::string("save its rows in their own file")
                            : fmt::format("read it with --{} {}", kind, other.name)));
      if (options.topic.empty() && !apart && is_inertial(other))
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
  if (!options.rate) table.time = TimeColumn{time_name, "ns", first.times.take()};
  table.row = [](std::size_t i) { return fmt::format("sample {}", i); };
  return table;
}

}  // namespace imunoise::recording
