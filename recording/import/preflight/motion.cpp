#include "recording/import/preflight/motion.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "core/stillness/stillness.h"
#include "core/support/rough.h"
#include "recording/import/preflight/holes.h"
#include "recording/import/table/names.h"

namespace imunoise::recording {
namespace {

constexpr double kLearning = 31.0;    // s before the watch begins
constexpr double kBackwards = 300.0;  // s from which the beginning is judged

// What hangs for most of the time has no usual scatter to judge the rest by.
bool mostly_hangs(const Column& column) {
  const std::size_t rows = size(column.samples);
  std::size_t same = 0;
  for (std::size_t i = 1; i < rows; ++i) same += repeats(column, i) ? 1U : 0U;
  return 2 * same > rows;
}

}  // namespace

std::string Motion::said(double from, double to, std::string_view done) const {
  if (several)
    return fmt::format("disturbed from {:.6g} to {:.6g} s ({} by {} times its usual scatter): {}",
                       from, to, channel, rough(size), done);
  return fmt::format(
      "{} changes from {:.6g} to {:.6g} s, by {} times its usual scatter, and no other channel "
      "does: {}; --exclude {:.6g}..{:.6g} leaves it out",
      channel, from, to, rough(size), done, from, to);
}

std::vector<std::size_t> channels_of_motion(const std::vector<Column>& columns,
                                            const std::vector<Unit>& units) {
  std::vector<std::size_t> out;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const bool known = units[c].quantity != Quantity::kUnknown;
    if (of_inertia(known ? units[c].quantity : role_of(columns[c].name).quantity)) out.push_back(c);
  }
  return out;
}

std::vector<Motion> motion_in(const std::vector<Column>& columns, const std::vector<Unit>& units,
                              Hertz rate, const std::function<bool(std::size_t)>& broken) {
  const std::vector<std::size_t> watched = channels_of_motion(columns, units);
  std::vector<Motion> out;
  if (watched.empty()) return out;
  std::vector<double> quanta;
  for (const std::size_t c : watched)
    quanta.push_back(std::holds_alternative<std::vector<double>>(columns[c].samples) ? 0.0 : 1.0);
  const std::size_t rows = size(columns.front().samples);
  const auto take = [&](Stillness& watch, std::size_t row) {
    for (std::size_t c = 0; c < watched.size(); ++c) {
      std::visit([&](const auto& values) { watch.take(c, static_cast<double>(values[row])); },
                 columns[watched[c]].samples);
    }
    watch.end_row(static_cast<std::int64_t>(row));
  };
  const auto add = [&](const Disturbance& one) {
    const auto [begin, end] = std::minmax(one.begin, one.end);
    out.push_back({static_cast<std::size_t>(begin), static_cast<std::size_t>(end) + 1,
                   columns[watched[one.channel]].name, one.size, one.channels > 1});
  };
  const auto whole = [&](std::size_t row) {
    return std::none_of(watched.begin(), watched.end(), [&](std::size_t c) {
      const auto* const values = std::get_if<std::vector<double>>(&columns[c].samples);
      return values != nullptr && !std::isfinite((*values)[row]);
    });
  };
  const double learning = kLearning * rate.value;
  Stillness backwards(rate, quanta);
  const auto far =
      static_cast<std::size_t>(std::min(static_cast<double>(rows), kBackwards * rate.value));
  for (std::size_t row = far; row-- > 0;) {
    if (row + 1 < rows && broken(row + 1)) backwards.lost();
    if (whole(row)) take(backwards, row);
  }
  for (const Disturbance& one : backwards.found()) {
    if (static_cast<double>(one.end) < learning) add(one);
  }
  std::reverse(out.begin(), out.end());
  const std::size_t early = out.empty() ? 0 : out.back().end;
  Stillness forwards(rate, quanta);
  for (std::size_t row = 0; row < rows; ++row) {
    if (broken(row)) forwards.lost();
    if (whole(row)) take(forwards, row);
  }
  for (const Disturbance& one : forwards.found()) {
    if (static_cast<std::size_t>(one.begin) >= early) add(one);
  }
  for (const std::size_t c : watched) {
    const auto alone = [&](const Motion& one) {
      return !one.several && one.channel == columns[c].name;
    };
    if (std::any_of(out.begin(), out.end(), alone) && mostly_hangs(columns[c]))
      std::erase_if(out, alone);
  }
  return out;
}

}  // namespace imunoise::recording
