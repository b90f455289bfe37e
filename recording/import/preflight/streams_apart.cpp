#include "recording/import/preflight/streams_apart.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <variant>

#include "recording/import/preflight/clock.h"
#include "recording/import/table/names.h"
#include "recording/import/table/streams.h"

namespace imunoise::recording {
namespace {

constexpr double kMany = 0.1;            // of the rows
constexpr double kTurns = 0.25;          // of the rows, that are of another sensor than the last
constexpr std::size_t kRowsOfEach = 16;  // of each sensor
constexpr double kFarthest = 4e9;  // s: 127 years. Differences of such times fit into int64 as ns.

struct Missing {
  std::uint64_t which = 14695981039346656037U;  // tells the rows (FNV-1a)
  std::size_t count = 0;
};

Missing missing_in(const Column& column) {
  Missing out;
  const auto* const values = std::get_if<std::vector<double>>(&column.samples);
  if (values == nullptr) return out;
  for (std::size_t i = 0; i < values->size(); ++i) {
    if (std::isfinite((*values)[i])) continue;
    out.which = (out.which ^ i) * 1099511628211U;
    ++out.count;
  }
  return out;
}

// Of each column what its sensor misses: the axis that misses least of those of a sensor. Another
// axis that misses more is broken, no sensor of its own.
std::vector<Missing> missing_of_sensors(const std::vector<Column>& columns) {
  std::map<std::pair<Quantity, std::string>, Missing> least;
  std::vector<Missing> out;
  for (const Column& column : columns) {
    out.push_back(missing_in(column));
    const Role role = role_of(column.name);
    if (!of_inertia(role.quantity) || role.axis == ' ') continue;
    const auto [at, is_new] = least.emplace(std::pair{role.quantity, role.sensor}, out.back());
    if (!is_new && out.back().count < at->second.count) at->second = out.back();
  }
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const Role role = role_of(columns[c].name);
    const auto sensor = least.find(std::pair{role.quantity, role.sensor});
    if (role.axis != ' ' && sensor != least.end()) out[c] = sensor->second;
  }
  return out;
}

bool has_value(const Column& column, std::size_t row) {
  const auto* const values = std::get_if<std::vector<double>>(&column.samples);
  return values == nullptr || std::isfinite((*values)[row]);
}

void leave_out_empty(Table& table) {
  const auto empty = [](const Column& column) {
    return missing_in(column).count == size(column.samples);
  };
  if (std::all_of(table.columns.begin(), table.columns.end(), empty)) return;
  for (const Column& column : table.columns) {
    if (empty(column))
      table.notes.push_back(fmt::format("column {} holds no value: left out", column.name));
  }
  std::erase_if(table.columns, empty);
}

TimedStream stream_of(const std::vector<Column*>& columns, const Clock& clock) {
  TimedStream out;
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < clock.size(); ++i) {
    const bool any = std::any_of(columns.begin(), columns.end(),
                                 [&](const Column* one) { return has_value(*one, i); });
    if (any) rows.push_back(i);
  }
  for (const std::size_t row : rows) {
    const double time = std::clamp(clock.at(row), -kFarthest, kFarthest);
    out.times.push(static_cast<std::int64_t>(std::llround(time * 1e9)));
  }
  for (Column* const from : columns) {
    out.name += (out.name.empty() ? "" : ",") + from->name;
    Column& to =
        out.columns.emplace_back(Column{from->name, {}, from->scale, from->offset, from->unit});
    std::vector<double> values;
    std::visit(
        [&](const auto& numbers) {
          for (const std::size_t row : rows) values.push_back(static_cast<double>(numbers[row]));
        },
        from->samples);
    to.samples = std::move(values);
    from->samples = std::vector<double>();
  }
  return out;
}

bool is_many(const Missing& missing, const Column& in) {
  return static_cast<double>(missing.count) > kMany * static_cast<double>(size(in.samples));
}

// The column that says which of several sensors a row is of: small whole numbers, each in many
// rows.
std::optional<std::size_t> column_of_sensors(const Table& table) {
  constexpr std::size_t kMost = 16;  // sensors
  constexpr double kHighest = 1e6;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const Column& column = table.columns[c];
    const auto* const values = std::get_if<std::vector<double>>(&column.samples);
    if (values == nullptr || !column.unit.empty() || !names_a_sensor(column.name)) continue;
    std::map<double, std::size_t> rows;
    std::size_t turns = 0;
    for (std::size_t i = 1; i < values->size(); ++i)
      turns += (*values)[i] != (*values)[i - 1] ? 1U : 0U;
    if (static_cast<double>(turns) < kTurns * static_cast<double>(values->size())) continue;
    for (const double one : *values) {
      const bool number = one >= 0.0 && one < kHighest && one == std::floor(one);
      if (!number || ++rows[one] == 0 || rows.size() > kMost) {
        rows.clear();
        break;
      }
    }
    const bool each = std::all_of(rows.begin(), rows.end(),
                                  [](const auto& one) { return one.second >= kRowsOfEach; });
    if (rows.size() > 1 && each) return c;
  }
  return std::nullopt;
}

std::string name_of(const TimedStream& sensor, const std::string& column) {
  return fmt::format("{}_{}", sensor.name, column);
}

// The rows of each sensor, a stream imuN each.
std::vector<TimedStream> streams_of_sensors(Table& table, std::size_t which, const Clock& clock) {
  const auto sensors = std::get<std::vector<double>>(table.columns[which].samples);
  table.columns.erase(table.columns.begin() + static_cast<std::ptrdiff_t>(which));
  std::map<double, TimedStream> out;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    TimedStream& to = out[sensors[i]];
    const double time = std::clamp(clock.at(i), -kFarthest, kFarthest);
    to.times.push(static_cast<std::int64_t>(std::llround(time * 1e9)));
  }
  for (auto& one : out) {
    const double sensor = one.first;
    TimedStream& to = one.second;
    to.name = fmt::format("imu{}", sensor);
    for (const Column& from : table.columns) {
      std::vector<double> values;
      std::visit(
          [&](const auto& numbers) {
            for (std::size_t i = 0; i < sensors.size(); ++i) {
              if (sensors[i] == sensor) values.push_back(static_cast<double>(numbers[i]));
            }
          },
          from.samples);
      to.columns.push_back(
          Column{name_of(to, from.name), std::move(values), from.scale, from.offset, from.unit});
    }
  }
  std::vector<TimedStream> streams;
  for (auto& [sensor, stream] : out) streams.push_back(std::move(stream));
  return streams;
}

}  // namespace

std::size_t put_first(const std::vector<std::string>& names, std::vector<Column>& columns) {
  auto next = columns.begin();
  for (const std::string& name : names) {
    const auto found =
        std::find_if(next, columns.end(), [&](const Column& one) { return one.name == name; });
    if (found == columns.end()) continue;
    std::rotate(next, found, found + 1);
    ++next;
  }
  return static_cast<std::size_t>(next - columns.begin());
}

void drop_sparse(std::size_t wanted, std::vector<Column>& columns) {
  const auto first = columns.begin() + static_cast<std::ptrdiff_t>(wanted);
  if (first == columns.end() || wanted == 0) return;
  bool sparse = false;
  std::set<std::uint64_t> rows;  // that the wanted ones miss
  for (auto one = columns.begin(); one != first; ++one) {
    const Missing missing = missing_in(*one);
    sparse = sparse || is_many(missing, *one);
    rows.insert(missing.which);
  }
  const auto of_other_rows = [&](const Column& one) {
    const Missing missing = missing_in(one);
    return sparse ? rows.size() > 1 || missing.which != *rows.begin() : is_many(missing, one);
  };
  columns.erase(std::remove_if(first, columns.end(), of_other_rows), columns.end());
}

Result<Table> take_apart(const std::string& file, Table table, const ImportOptions& options,
                         std::vector<std::string>& wanted) {
  leave_out_empty(table);
  const std::optional<std::size_t> sensors = column_of_sensors(table);
  if (sensors && (!table.time || options.rate))
    return fail(
        fmt::format("{}: column {} says which of several sensors a row is of, and without times "
                    "they cannot be told apart; put the rows of each into a file of its own",
                    file, table.columns[*sensors].name));
  if (!table.time || options.rate) return table;
  const std::size_t rows = size(table.time->stamps);
  std::map<std::uint64_t, std::vector<Column*>> groups;
  bool many = false;
  const std::vector<Missing> missing = missing_of_sensors(table.columns);
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    many = many || static_cast<double>(missing[c].count) > kMany * static_cast<double>(rows);
    groups[missing[c].which].push_back(&table.columns[c]);
  }
  if (!many && !sensors) return table;
  const auto clock = Clock::read(fmt::format("{}: column {}", file, table.time->name), *table.time,
                                 options.time_unit);
  if (!clock) return tl::make_unexpected(clock.error());
  std::vector<TimedStream> streams;
  if (sensors) {
    const std::string name = table.columns[*sensors].name;
    streams = streams_of_sensors(table, *sensors, *clock);
    table.notes.push_back(
        fmt::format("column {} says which of {} sensors a row is of: each has "
                    "channels of its own",
                    name, streams.size()));
    std::vector<std::string> named;
    for (const TimedStream& one : streams) {
      for (const std::string& column : wanted) named.push_back(name_of(one, column));
    }
    wanted = std::move(named);
  } else {
    for (const auto& [which, columns] : groups) streams.push_back(stream_of(columns, *clock));
  }
  // What was wanted was chosen by the reader.
  ImportOptions all = options;
  all.topic.clear();
  if (options.channels.size() != 1 || sensors) all.channels.clear();
  Result<Table> out =
      join_streams(file, std::move(streams), table.time->name, all, sensors ? "sensor" : "channel");
  if (!out) return out;
  out->notes.insert(out->notes.begin(), table.notes.begin(), table.notes.end());
  if (!sensors) out->notes.emplace_back("rows hold different sensors");
  if (out->time) out->time->said = clock->said();
  out->unreadable = table.unreadable;
  out->first_unreadable = table.first_unreadable;
  out->truncated = table.truncated;
  return out;
}

}  // namespace imunoise::recording
