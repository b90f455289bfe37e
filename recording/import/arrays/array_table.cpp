#include "recording/import/arrays/array_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "recording/import/table/select.h"
#include "recording/import/table/time_names.h"

namespace imunoise::recording {

Result<ArrayTable> ArrayTable::choose(std::string file, std::vector<NamedArray> arrays,
                                      const ImportOptions& options) {
  ArrayTable out(std::move(file), std::move(arrays), options);
  std::vector<Shape> shapes;
  for (const NamedArray& one : out.arrays_) shapes.push_back(one.shape);
  out.length_ = common_length(shapes);
  out.wanted_.resize(out.arrays_.size());
  out.taken_.resize(out.arrays_.size());
  out.find_time_and_rate();
  if (auto chosen = out.choose_columns(); !chosen) return tl::make_unexpected(chosen.error());
  return out;
}

// Whether time runs along the columns.
bool ArrayTable::across(std::size_t array) const {
  const Shape& shape = arrays_[array].shape;
  return shape.rows != length_ && (shape.columns == length_ || shape.columns > shape.rows);
}

std::size_t ArrayTable::columns_of(std::size_t array) const {
  const Shape& shape = arrays_[array].shape;
  return across(array) ? shape.rows : shape.columns;
}

void ArrayTable::find_time_and_rate() {
  if (options_.rate) return;
  for (std::size_t a = 0; a < arrays_.size(); ++a) {
    const NamedArray& one = arrays_[a];
    if (table_.time || !is_time_name(last_part(one.name)) || one.shape.shorter() != 1 ||
        one.shape.longer() != length_)
      continue;
    table_.time = TimeColumn{one.name, "", {}};
    wanted_[a].push_back({0, kTime});
  }
  if (table_.time) return;
  for (const NamedArray& one : arrays_) {
    const double rate = one.number ? rate_called(one.name, *one.number) : 0.0;
    if (rate > 0.0) table_.rate = {rate, "its " + one.name};
  }
}

Result<void> ArrayTable::choose_columns() {
  std::vector<Offer> offers;
  std::vector<std::pair<std::size_t, std::size_t>> places;  // array, column
  for (std::size_t a = 0; a < arrays_.size(); ++a) {
    const NamedArray& one = arrays_[a];
    if (one.shape.is_single()) continue;
    const std::size_t columns = columns_of(a);
    if (columns > kMaximumColumns || places.size() + columns > kMaximumColumns) {
      return fail(fmt::format("{}: array {} has {} rows and {} columns; name fewer arrays in it",
                              file_, one.name, one.shape.rows, one.shape.columns));
    }
    const bool fits = (across(a) ? one.shape.columns : one.shape.rows) == length_;
    const bool is_time = is_time_name(last_part(one.name));
    if (!fits) {
      table_.notes.push_back(fmt::format("array {} ({} x {}) has another length: left out",
                                         one.name, one.shape.rows, one.shape.columns));
    }
    for (const std::string& name : column_names(one.name, columns)) {
      offers.push_back({name, fits && !is_time});
      places.emplace_back(
          a, places.empty() || places.back().first != a ? 0 : places.back().second + 1);
    }
  }
  const auto wanted = select_columns(file_, offers, options_);
  if (!wanted) return tl::make_unexpected(wanted.error());
  for (const std::size_t w : *wanted) {
    const auto [array, column] = places[w];
    wanted_[array].push_back({column, table_.columns.size()});
    table_.columns.push_back({offers[w].name, {}, 1.0, 0.0, ""});
  }
  columns_.resize(table_.columns.size());
  return {};
}

void ArrayTable::take(std::size_t array, double number) {
  const NamedArray& one = arrays_[array];
  const std::uint64_t index = taken_[array]++;
  // Of the two indices, the one that runs slower in the file comes first.
  const std::uint64_t inner = one.column_major ? one.shape.rows : one.shape.columns;
  const std::uint64_t slow = index / inner;
  const std::uint64_t fast = index % inner;
  const bool slow_is_column = one.column_major != across(array);
  const std::uint64_t column = slow_is_column ? slow : fast;
  for (const Part& part : wanted_[array]) {
    if (part.column != column) continue;
    const double value = std::isfinite(number) ? number : std::numeric_limits<double>::quiet_NaN();
    (part.to == kTime ? times_ : columns_[part.to]).push_back(value);
  }
}

Result<Table> ArrayTable::finish() {
  for (std::size_t a = 0; a < arrays_.size(); ++a) {
    const Shape& shape = arrays_[a].shape;
    if (!wants(a) || taken_[a] == shape.rows * shape.columns) continue;
    return fail(
        fmt::format("{}: array {} announces {} x {} numbers and holds {}; copy or save it "
                    "again",
                    file_, arrays_[a].name, shape.rows, shape.columns, taken_[a]));
  }
  for (std::size_t c = 0; c < columns_.size(); ++c)
    table_.columns[c].samples = std::move(columns_[c]);
  if (table_.time) table_.time->stamps = std::move(times_);
  table_.row = [](std::size_t i) { return fmt::format("sample {}", i); };
  if (table_.time || table_.rate || options_.rate || table_.columns.size() < 2 ||
      !options_.channels.empty() ||
      !rises_steadily(std::get<std::vector<double>>(table_.columns.front().samples)))
    return std::move(table_);
  Column& first = table_.columns.front();
  table_.time = TimeColumn{first.name, "", std::get<std::vector<double>>(std::move(first.samples))};
  table_.columns.erase(table_.columns.begin());
  table_.notes.push_back(fmt::format("time: {}, because it rises steadily", table_.time->name));
  return std::move(table_);
}

}  // namespace imunoise::recording
