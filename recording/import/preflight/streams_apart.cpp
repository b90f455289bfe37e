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
constexpr std::size_t kRowsOfEach = 16;  // of a sensor, at least
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

using Rows = std::vector<std::size_t>;

Times times_at(const Rows& rows, const Clock& clock) {
  Times out;
  for (const std::size_t row : rows) {
    const double time = std::clamp(clock.at(row), -kFarthest, kFarthest);
    out.push(static_cast<std::int64_t>(std::llround(time * 1e9)));
  }
  return out;
}

Column column_at(const Rows& rows, const Column& from) {
  std::vector<double> values;
  std::visit(
      [&](const auto& numbers) {
        for (const std::size_t row : rows) values.push_back(static_cast<double>(numbers[row]));
      },
      from.samples);
  return {from.name, std::move(values), from.scale, from.offset, from.unit};
}

TimedStream stream_of(const std::vector<Column*>& columns, const Clock& clock) {
  Rows rows;
  for (std::size_t i = 0; i < clock.size(); ++i) {
    const bool any = std::any_of(columns.begin(), columns.end(),
                                 [&](const Column* one) { return has_value(*one, i); });
    if (any) rows.push_back(i);
  }
  TimedStream out{"", times_at(rows, clock), {}};
  for (Column* const from : columns) {
    out.name += (out.name.empty() ? "" : ",") + from->name;
    out.columns.push_back(column_at(rows, *from));
    from->samples = std::vector<double>();
  }
  return out;
}

bool is_many(const Missing& missing, const Column& in) {
  return static_cast<double>(missing.count) > kMany * static_cast<double>(size(in.samples));
}

// The rows of each sensor, if these are numbers of sensors that take turns: small whole numbers,
// each in many rows. Empty: they are not.
std::map<double, Rows> rows_of_sensors(const std::vector<double>& numbers) {
  constexpr std::size_t kMost = 16;  // sensors
  constexpr double kTurns = 0.25;    // share of the rows that change the sensor, at least
  constexpr double kHighest = 1e6;
  std::map<double, Rows> out;
  std::size_t turns = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const double one = numbers[i];
    if (!(one >= 0.0 && one < kHighest && one == std::floor(one))) return {};
    turns += i > 0 && one != numbers[i - 1] ? 1U : 0U;
    out[one].push_back(i);
    if (out.size() > kMost) return {};
  }
  const bool each = std::all_of(out.begin(), out.end(),
                                [](const auto& one) { return one.second.size() >= kRowsOfEach; });
  const bool alternate = static_cast<double>(turns) >= kTurns * static_cast<double>(numbers.size());
  return out.size() > 1 && each && alternate ? out : std::map<double, Rows>();
}

struct Sensors {
  std::size_t column = 0;  // that has their numbers
  std::map<double, Rows> rows;
};

std::optional<Sensors> sensors_in(const Table& table) {
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const Column& column = table.columns[c];
    if (!column.unit.empty() || !names_a_sensor(column.name)) continue;
    const std::vector<double> numbers =
        std::visit([](const auto& all) { return std::vector<double>(all.begin(), all.end()); },
                   column.samples);
    std::map<double, Rows> rows = rows_of_sensors(numbers);
    if (!rows.empty()) return Sensors{c, std::move(rows)};
  }
  return std::nullopt;
}

// A stream imuN for each sensor. In `wanted`, each sensor's columns take the place of the table's.
std::vector<TimedStream> streams_of(const Sensors& sensors, Table& table, const Clock& clock,
                                    std::vector<std::string>& wanted) {
  table.columns.erase(table.columns.begin() + static_cast<std::ptrdiff_t>(sensors.column));
  std::vector<TimedStream> out;
  std::vector<std::string> named;
  for (const auto& [number, rows] : sensors.rows) {
    TimedStream& to =
        out.emplace_back(TimedStream{fmt::format("imu{}", number), times_at(rows, clock), {}});
    for (const std::string& one : wanted) named.push_back(to.name + "_" + one);
    for (const Column& from : table.columns) {
      to.columns.push_back(column_at(rows, from));
      to.columns.back().name = to.name + "_" + from.name;
    }
  }
  wanted = std::move(named);
  return out;
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
  const std::optional<Sensors> sensors = sensors_in(table);
  const std::string numbered = sensors ? table.columns[sensors->column].name : "";
  if (sensors && (!table.time || options.rate))
    return fail(
        fmt::format("{}: column {} numbers {} sensors, and only time stamps tell their rows apart; "
                    "leave --rate out, or save the rows of each sensor in its own file",
                    file, numbered, sensors->rows.size()));
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
    streams = streams_of(*sensors, table, *clock, wanted);
    table.notes.push_back(fmt::format("column {} numbers {} sensors: each has its own channels",
                                      numbered, streams.size()));
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
