#include "recording/import/preflight/preflight.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

#include "core/support/counted.h"
#include "recording/import/preflight/cuts.h"
#include "recording/import/preflight/dropped_rows.h"
#include "recording/import/preflight/frozen.h"
#include "recording/import/preflight/gravity.h"
#include "recording/import/preflight/holes.h"
#include "recording/import/preflight/motion.h"
#include "recording/import/preflight/pace.h"
#include "recording/import/preflight/recognised.h"
#include "recording/import/preflight/streams_apart.h"
#include "recording/import/preflight/suspect.h"
#include "recording/import/table/names.h"
#include "recording/import/table/select.h"

namespace imunoise::recording {
namespace {

// The number with the fewest digits within a relative distance of `value`.
double shortest(double value, double relative) {
  for (int digits = 1; digits < 17; ++digits) {
    const double candidate = std::stod(fmt::format("{:.{}e}", value, digits - 1));
    if (std::abs(candidate / value - 1.0) <= relative) return candidate;
  }
  return value;
}

class Judge {
 public:
  Judge(const std::string& file, Table table, std::size_t wanted, const ImportOptions& options)
      : file_(file), table_(std::move(table)), wanted_(wanted), options_(options) {}

  Result<Judged> judged() {
    rows_ = recording::size(table_.columns.front().samples);
    report_.file = file_;
    report_.samples = rows_;
    report_.recognised = table_.notes;
    report_.others = std::move(table_.others);
    if (table_.truncated)
      find(Severity::kLeftOut, "the file is truncated: what comes before its end is used");
    const auto readable = check_readable();
    if (!readable) return tl::make_unexpected(readable.error());
    if (rows_ < kMinimumSamples) return too_few(rows_, "");
    const auto paced = table_.time ? follow_time() : take_rate();
    if (!paced) return tl::make_unexpected(paced.error());
    for (std::string& said : rates_of_increments(table_.columns, out_.rate))
      report_.recognised.push_back(std::move(said));
    const auto resolved = resolve_units();
    if (!resolved) return tl::make_unexpected(resolved.error());
    for (std::string& said :
         judge_acceleration(table_.columns, out_.units, wanted_, report_.findings))
      report_.recognised.push_back(std::move(said));
    for (std::string& said :
         channels_in_words(wanted_columns(), std::span(out_.units).first(wanted_), options_.units))
      report_.recognised.push_back(std::move(said));
    find_missing();
    leave_out_times();
    find_frozen();
    find_motion();
    const auto cut = cut_stretches();
    if (!cut) return tl::make_unexpected(cut.error());
    const Stretch& longest =
        *std::max_element(out_.stretches.begin(), out_.stretches.end(),
                          [](const Stretch& a, const Stretch& b) { return a.count < b.count; });
    find_suspects(table_.columns, out_.units, wanted_, out_.rate, longest.begin, longest.count,
                  report_.findings);
    if (options_.strict && !report_.findings.empty()) return refuse("--strict refuses the file");
    table_.columns.resize(wanted_);
    out_.units.resize(wanted_);
    out_.columns = std::move(table_.columns);
    out_.report = std::make_shared<const Preflight>(std::move(report_));
    return std::move(out_);
  }

 private:
  void find(Severity severity, std::string text) {
    report_.findings.push_back({severity, std::move(text)});
  }

  tl::unexpected<Error> refuse(const std::string& what) const {
    std::string text = fmt::format("{}: {}", file_, what);
    for (const Finding& one : report_.findings) text += "\n  " + one.text;
    return fail(std::move(text));
  }

  tl::unexpected<Error> too_few(std::size_t samples, const char* where) const {
    if (rows_ == 0) return refuse("holds no rows of numbers");
    if (options_.from || options_.until || !options_.exclude.empty())
      return refuse(fmt::format(
          "--from, --until and --exclude leave {} of {}{}: a replicate needs at least {}", samples,
          counted(rows_, "sample"), where, kMinimumSamples));
    return refuse(fmt::format("{}{}: too few, a replicate needs at least {}; record longer",
                              counted(samples, "sample"), where, kMinimumSamples));
  }

  std::string row(std::size_t i) const { return table_.row(dropped_.counted(i)); }

  std::span<const Column> wanted_columns() const { return {table_.columns.data(), wanted_}; }

  // s
  double time_of(std::size_t i) const {
    return clock_ ? clock_->at(i) : static_cast<double>(i) / out_.rate.value;
  }

  void drop(const std::vector<std::size_t>& rows) {
    std::vector<bool> dropped(rows_, false);
    for (const std::size_t one : rows) dropped[one] = true;
    for (Column& column : table_.columns)
      std::visit([&](auto& values) { keep_others(values, dropped); }, column.samples);
    std::visit([&](auto& values) { keep_others(values, dropped); }, table_.time->stamps);
    rows_ -= rows.size();
    dropped_.add(rows);
  }

  Result<void> check_readable() {
    if (table_.unreadable == 0) return {};
    find(Severity::kLeftOut,
         fmt::format("{} cannot be read: left out; the first is {}",
                     counted(table_.unreadable, "row"), table_.first_unreadable));
    if (2 * table_.unreadable <= rows_) return {};
    return fail(
        fmt::format("{}: {} cannot be read; the first is {}; give names and rows the same "
                    "columns, or leave columns out with --channel",
                    file_, counted(table_.unreadable, "row"), table_.first_unreadable));
  }

  // All that are wrong are told at once.
  Result<void> resolve_units() {
    std::string wrong;
    for (std::size_t c = 0; c < table_.columns.size(); ++c) {
      const Column& column = table_.columns[c];
      Result<Unit> unit = resolve_unit(file_, column.name, column.unit, options_);
      if (!unit && c >= wanted_) unit = Unit{column.unit, Quantity::kUnknown, 1.0};
      if (!unit) wrong += (wrong.empty() ? "" : "\n") + unit.error().message;
      if (unit) out_.units.push_back(std::move(*unit));
    }
    if (!wrong.empty()) return fail(std::move(wrong));
    return check_rules();
  }

  // A mistyped pattern; where some of the columns are read, it may be of the others.
  Result<void> check_rules() const {
    if (!options_.channels.empty() || !options_.topic.empty() || !report_.others.empty()) return {};
    std::string names;
    for (const Column& column : table_.columns) names += (names.empty() ? "" : ", ") + column.name;
    for (const UnitRule& rule : options_.units) {
      const bool used =
          std::any_of(table_.columns.begin(), table_.columns.end(),
                      [&](const Column& column) { return matches(rule.pattern, column.name); });
      if (!used)
        return fail(fmt::format("{}: --unit {}={}: no channel has this name (there are {})", file_,
                                rule.pattern, rule.unit.symbol, names));
    }
    return {};
  }

  Result<void> take_rate() {
    if (options_.rate) {
      out_.rate = *options_.rate;
      report_.recognised.push_back(fmt::format("time: {:.6g} Hz (--rate)", out_.rate.value));
      return {};
    }
    if (!table_.rate) {
      return fail(fmt::format(
          "{}: no time column (t, time, timestamp), no rate_hz and so no sampling rate; "
          "give it with --rate HZ",
          file_));
    }
    const auto rate = checked_rate(file_, table_.rate->where, table_.rate->hertz);
    if (!rate) return tl::make_unexpected(rate.error());
    out_.rate = *rate;
    report_.recognised.push_back(
        fmt::format("time: {:.6g} Hz ({})", rate->value, table_.rate->where));
    return {};
  }

  Result<void> read_clock() {
    const std::string place = fmt::format("{}: column {}", file_, table_.time->name);
    auto clock = Clock::read(place, *table_.time, options_.time_unit);
    if (!clock) return tl::make_unexpected(clock.error());
    clock_ = std::move(*clock);
    return {};
  }

  Result<void> leave_out_repeated(const std::vector<std::size_t>& rows) {
    if (rows.empty()) return {};
    find(Severity::kLeftOut,
         fmt::format("{} rows repeat the row before, time included: left out; the first is {}",
                     rows.size(), row(rows.front())));
    drop(rows);
    if (rows_ < kMinimumSamples) return too_few(rows_, "");
    return read_clock();
  }

  Result<void> follow_time() {
    const auto same = [&](std::size_t i) {
      return std::all_of(table_.columns.begin(), table_.columns.end(),
                         [&](const Column& one) { return repeats(one, i); });
    };
    if (auto read = read_clock(); !read) return read;
    if (auto left = leave_out_repeated(logged_twice(*clock_, same)); !left) return left;
    Pace pace = pace_of(*clock_, same);
    if (!pace.twice.empty()) {
      if (auto left = leave_out_repeated(pace.twice); !left) return left;
      pace = pace_of(*clock_, same);
    }
    const double relative = (pace.scatter + 4.0 * clock_->rounding()) / pace.span;
    out_.rate = {shortest(1.0 / pace.period, std::max(1e-12, relative))};
    out_.jitter = pace.jitter;
    std::string said = fmt::format("time: {}; {:.8g} Hz", clock_->said(), out_.rate.value);
    if (pace.jitter > 0.01) said += fmt::format(", jitter {:.2g} periods", pace.jitter);
    report_.recognised.push_back(std::move(said));
    if (pace.jitter > 0.5)
      find(Severity::kDoubt, fmt::format("stamps are coarse or come in bursts (jitter {:.2g} "
                                         "periods): short gaps may stay hidden",
                                         pace.jitter));
    if (!clock_->doubt().empty()) find(Severity::kDoubt, clock_->doubt());
    if (pace.backwards > 0)
      find(Severity::kDoubt,
           fmt::format("{} stamps go back for a moment: are rows out of order?", pace.backwards));
    for (const OtherPace& one : pace.others) {
      cuts_.add(one.begin, one.end);
      find(Severity::kLeftOut, words_of(one, *clock_, pace.period));
    }
    tell_leaps(pace);
    return {};
  }

  void tell_leaps(const Pace& pace) {
    std::size_t told = 0;
    for (const Leap& leap : pace.leaps) {
      cuts_.add(leap.at, leap.at);
      const bool back = leap.seconds < 0.0;
      const auto lost = static_cast<std::uint64_t>(
          std::max(1.0, std::min(1e15, std::round(leap.seconds / pace.period))));
      if (!back) {
        ++out_.gaps;
        out_.lost += lost;
      }
      if (told++ >= kTold) continue;
      find(Severity::kLeftOut,
           back ? fmt::format("time goes backwards by {:.6g} s at {:.6g} s ({}): cut there",
                              -leap.seconds, clock_->at(leap.at - 1), row(leap.at))
                : fmt::format("gap of {:.6g} s at {:.6g} s ({}), about {}: cut there", leap.seconds,
                              clock_->at(leap.at - 1), row(leap.at), counted(lost, "sample")));
    }
    if (told > kTold)
      find(Severity::kLeftOut, fmt::format("{} more gaps: cut there", told - kTold));
    constexpr std::size_t kShort = 1000;  // samples of a stretch
    if (out_.gaps > kTold && rows_ < kShort * out_.gaps)
      find(Severity::kDoubt,
           fmt::format(
               "{:.2g} % of the samples are lost in {} places, so that stretches are short: "
               "slow noise does not show; find the cause, or take the rows as if none were "
               "lost with --rate {:.6g}",
               100.0 * static_cast<double>(out_.lost) / static_cast<double>(out_.lost + rows_),
               out_.gaps, out_.rate.value));
  }

  void find_missing() {
    for (const Column& column : wanted_columns()) {
      for (std::size_t i = 0; i < rows_; ++i) {
        if (missing(column, i)) cuts_.add_row(i);
      }
    }
    for (const Hole& one : holes_in(wanted_columns())) {
      std::string text = fmt::format("{}, the first at {:.6g} s ({}): left out", one.said(),
                                     time_of(one.first), row(one.first));
      if (10 * one.count > rows_)
        text += "; if the file mixes sensors of two rates, read each with --channel";
      find(Severity::kLeftOut, std::move(text));
    }
  }

  // Rows from the first at or after each border.
  std::size_t row_at(double seconds) const {
    std::size_t low = 0;
    std::size_t high = rows_;
    while (low < high) {
      const std::size_t middle = low + (high - low) / 2;
      (time_of(middle) < seconds ? low : high) = time_of(middle) < seconds ? middle + 1 : middle;
    }
    return low;
  }

  void leave_out_times() {
    if (options_.from) cuts_.add(0, row_at(*options_.from));
    if (options_.until) cuts_.add(row_at(*options_.until), rows_);
    for (const TimeSpan& one : options_.exclude) {
      const Cut cut{row_at(one.begin), row_at(one.end)};
      cuts_.add(cut.begin, cut.end);
      if (!(one.end > 0.0 && one.begin <= time_of(rows_ - 1)))
        report_.recognised.push_back(fmt::format(
            "--exclude {:.6g}..{:.6g} excludes no sample: the file covers 0 to {:.6g} s", one.begin,
            one.end, time_of(rows_ - 1)));
    }
  }

  void find_frozen() {
    const bool used = options_.use_frozen;
    const Severity severity = used ? Severity::kDoubt : Severity::kLeftOut;
    std::size_t told = 0;
    for (const Cut& one : frozen_in(table_.columns, out_.units)) {
      if (!used) cuts_.add(one.begin, one.end);
      if (told++ < kTold)
        find(severity,
             fmt::format("all axes stand still from {:.6g} to {:.6g} s, where each sample repeats "
                         "the one before: {}",
                         time_of(one.begin), time_of(one.end - 1), used ? "used" : "left out"));
    }
    if (told > kTold) find(severity, fmt::format("{} more such times", told - kTold));
  }

  // What moves one channel alone may be its own noise: it is told, and used.
  void find_motion() {
    const std::vector<Cut> broken = cuts_.joined();
    const auto is_broken = [&](std::size_t row) {
      const auto after =
          std::upper_bound(broken.begin(), broken.end(), row,
                           [](std::size_t at, const Cut& cut) { return at < cut.begin; });
      return after != broken.begin() && row <= std::prev(after)->end;
    };
    const std::vector<Motion> all = motion_in(table_.columns, out_.units, out_.rate, is_broken);
    std::size_t rows = 0;
    for (const Motion& one : all) rows += one.several ? one.end - one.begin : 0;
    const bool moves = 2 * rows > rows_;
    if (moves)
      find(Severity::kDoubt,
           "the sensor does not lie still for more than half of the time: its "
           "motion is taken for noise");
    std::size_t count = 0;
    for (const Motion& one : all) {
      const bool out = one.several && !moves && !options_.use_disturbed;
      if (out) cuts_.add(one.begin, one.end);
      if (moves || count++ >= kTold) continue;
      const double begin = time_of(one.begin);
      const double end = time_of(std::min(one.end, rows_ - 1));
      find(out ? Severity::kLeftOut : Severity::kDoubt,
           one.said(begin, end, out ? "left out" : "used"));
    }
    if (count > kTold) find(Severity::kLeftOut, fmt::format("{} more disturbances", count - kTold));
  }

  Result<void> cut_stretches() {
    Cuts::Left left = cuts_.of(rows_);
    const std::size_t short_ones = left.all - left.stretches.size();
    out_.stretches = std::move(left.stretches);
    const std::size_t first = options_.from ? row_at(*options_.from) : 0;
    for (Stretch& one : out_.stretches) one.seconds = time_of(one.begin) - time_of(first);
    report_.stretches = out_.stretches.size();
    for (const Stretch& one : out_.stretches) report_.used += one.count;
    if (out_.stretches.empty())
      return too_few(left.longest, left.all > 1 ? " in the longest stretch" : "");
    if (short_ones > 0)
      find(Severity::kLeftOut, fmt::format("{} shorter than a tenth of the longest: left out",
                                           counted(short_ones, "stretch")));
    return {};
  }

  static constexpr std::size_t kTold = 5;
  const std::string& file_;
  Table table_;
  std::size_t wanted_;  // columns; those behind them are to judge by
  const ImportOptions& options_;
  std::size_t rows_ = 0;
  DroppedRows dropped_;
  std::optional<Clock> clock_;
  Cuts cuts_;
  Preflight report_;
  Judged out_;
};

}  // namespace

Result<Judged> judge(const std::string& file, Table table, const std::vector<std::string>& wanted,
                     const ImportOptions& options) {
  drop_sparse(put_first(wanted, table.columns), table.columns);
  std::vector<std::string> names = wanted;
  Result<Table> apart = take_apart(file, std::move(table), options, names);
  if (!apart) return tl::make_unexpected(apart.error());
  const std::size_t count = put_first(names, apart->columns);
  return Judge(file, std::move(*apart), count, options).judged();
}

}  // namespace imunoise::recording
