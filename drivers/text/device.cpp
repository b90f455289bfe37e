#include "drivers/text/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "drivers/plugin/or_throw.h"

namespace imunoise::text {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kRetry{500};
constexpr milliseconds kSilence{2000};
constexpr std::int64_t kRestart = 1'000'000'000;  // ns that a clock goes back when it starts again
constexpr double kRowsOfSilence = 20.0;

// Slope of times over their numbers by least squares: what jitters cancels out. ns a row.
double period_of(const std::vector<double>& numbers, const std::vector<std::int64_t>& times) {
  const double mean =
      std::accumulate(numbers.begin(), numbers.end(), 0.0) / static_cast<double>(numbers.size());
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double off = numbers[i] - mean;
    sum += off * static_cast<double>(times[i] - times[0]);
    squares += off * off;
  }
  return squares > 0.0 ? sum / squares : 0.0;
}

// By a counter that never goes back but to begin anew; 1 without one, and where it leaps: in `ns`
// hardly more than this many rows of `period` can have passed.
double rows_between(std::optional<std::uint64_t> before, std::optional<std::uint64_t> counter,
                    double ns, double period) {
  constexpr double kMost = 10.0;
  if (!before || !counter || *counter <= *before) return 1.0;
  const auto rows = static_cast<double>(*counter - *before);
  return rows * period <= kMost * ns ? rows : 1.0;
}

double to_three_digits(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2.0);
  return std::round(value / unit) * unit;
}

}  // namespace

TextDevice::TextDevice(Settings settings, const plugin::Host& host)
    : settings_(std::move(settings)), host_(host), wire_(host.wire_tap()) {
  listen();
  learn_columns();
  learn_rate();
  patience_ = std::max<Clock::duration>(
      kSilence, std::chrono::duration_cast<Clock::duration>(
                    std::chrono::duration<double>(kRowsOfSilence / stream_.nominal_rate_hz)));
}

void TextDevice::open(const plugin::Wait& wait) {
  source_ = settings_.place.open(wait);
  lines_.clear();
  midway_ = settings_.place.midway;
  flags_ = IMUNOISE_SAMPLE_AFTER_RESTART;
  last_time_ns_.reset();
  last_line_ = Clock::now();
}

void TextDevice::listen() {
  const plugin::Wait wait(host_.opening(), settings_.listen);
  open(wait);
  while (!ended_ && wait.ready(source_->descriptor())) hear();
  if (wait.cancelled())
    throw plugin::DeviceError(IMUNOISE_CANCELLED, settings_.place.name + ": cancelled");
}

void TextDevice::refuse(const std::string& what) const {
  throw plugin::DeviceError(IMUNOISE_NOT_FOUND, fmt::format("{}: {}", settings_.place.name, what));
}

// With content, as it came.
std::string TextDevice::first_line() const {
  for (const ArrivedLine& line : heard_) {
    const auto content = content_of(line.text, settings_.form);
    if (const auto* const text = std::get_if<std::string_view>(&content)) return std::string(*text);
  }
  const double seconds = std::chrono::duration<double>(settings_.listen).count();
  if (!heard_.empty())
    refuse(fmt::format("{} lines came in {:g} s, but none is a row; the first is '{:.60}'",
                       heard_.size(), seconds, heard_.front().text));
  refuse(
      fmt::format("nothing came in {:g} s; does it send by itself, at this baud? A program that "
                  "holds its output back prints at once with stdbuf -oL or python3 -u",
                  seconds));
}

void TextDevice::learn_columns() {
  const std::string first = first_line();
  const Separator separator = separator_of(first);
  std::vector<Column> columns;
  if (settings_.columns) {
    columns = plugin::or_throw(parse_columns(*settings_.columns));
  } else {
    const auto fields = split(first, separator);
    if (!is_header(fields))
      refuse(
          fmt::format("it prints no header; say what its columns are, such as "
                      "columns=time[s],gyro_x[deg/s],-; the first line is '{:.120}'",
                      first));
    columns = plugin::or_throw(parse_columns(fields));
  }
  stream_.name = "rows";
  for (const Column& one : columns) {
    if (one.role == ColumnRole::kValue) stream_.channels.push_back({one.name, one.unit});
    if (one.role == ColumnRole::kCounter) stream_.counter_maximum = settings_.counter_maximum;
    if (one.role == ColumnRole::kTime)
      stream_.device_time_tick_s = 1e-9 * static_cast<double>(one.nanoseconds);
  }
  rows_.emplace(std::move(columns), separator, settings_.form);
}

void TextDevice::learn_rate() {
  RowReader reader = *rows_;
  std::vector<std::int64_t> times;
  std::vector<std::optional<std::uint64_t>> counters;
  for (const ArrivedLine& line : heard_) {
    const auto read = reader.read(line.text);
    const auto* const row = std::get_if<TextRow>(&read);
    if (row == nullptr) continue;
    times.push_back(row->time_ns.value_or(line.host_time_ns));
    counters.push_back(row->counter);
  }
  if (times.empty())
    refuse(fmt::format("no row of {} columns came; the first line is '{:.120}'",
                       reader.columns().size(), first_line()));
  if (settings_.rate_hz) {
    stream_.nominal_rate_hz = *settings_.rate_hz;
    return;
  }
  constexpr std::size_t kFewest = 4;
  // By the counter, which shows rows that are missing.
  const double mean = static_cast<double>(times.back() - times.front()) /
                      static_cast<double>(std::max<std::size_t>(1, times.size() - 1));
  std::vector<double> numbers{0.0};
  for (std::size_t i = 1; i < times.size(); ++i) {
    const auto passed = static_cast<double>(times[i] - times[i - 1]);
    numbers.push_back(numbers.back() + rows_between(counters[i - 1], counters[i], passed, mean));
  }
  const double period = times.size() < kFewest ? 0.0 : period_of(numbers, times);
  if (!(period > 0.0) || (ended_ && stream_.device_time_tick_s == 0.0))
    refuse(
        fmt::format("the rate cannot be measured from {} rows; give it (rate=100), or listen "
                    "longer (listen=10)",
                    times.size()));
  stream_.nominal_rate_hz = to_three_digits(1e9 / period);
  host_.note(fmt::format("{}: {:g} rows a second", settings_.place.name, stream_.nominal_rate_hz));
}

drivers::DeviceInfo TextDevice::describe() {
  drivers::DeviceInfo out;
  out.streams = {stream_};
  out.product = "text";
  out.serial = settings_.place.name;
  return out;
}

bool TextDevice::reopen(const plugin::Wait& wait) {
  for (;;) {
    try {
      open(wait);
      rows_->restart();
      host_.note(settings_.place.name + ": it is back");
      return true;
    } catch (const plugin::DeviceError& error) {
      if (error.code() != IMUNOISE_NOT_FOUND && error.code() != IMUNOISE_DISCONNECTED) throw;
    }
    if (!wait.until(Clock::now() + kRetry)) return false;
  }
}

void TextDevice::read(plugin::Samples& samples, const plugin::Wait& wait) {
  if (!heard_.empty()) return deliver(samples);
  if (ended_) return samples.end();
  if (!source_ && !reopen(wait)) return;
  try {
    if (wait.ready(source_->descriptor())) hear();
    if (Clock::now() - last_line_ > patience_)
      throw plugin::DeviceError(IMUNOISE_DISCONNECTED,
                                settings_.place.name + ": it sends no more; is it powered?");
  } catch (const plugin::DeviceError&) {
    source_.reset();
    deliver(samples);
    throw;
  }
  deliver(samples);
}

// Takes what has come.
void TextDevice::hear() {
  std::array<std::uint8_t, 65'536> bytes;
  const std::optional<std::size_t> got = source_->read(bytes);
  const std::int64_t now = host_.now_ns();
  if (!got) {
    ended_ = true;
    if (!lines_.rest().empty()) take(lines_.rest(), now);
    return;
  }
  const drivers::Bytes come(bytes.data(), *got);
  if (wire_ && !come.empty()) wire_(come);
  lines_.push(come, [&](std::string_view line) { take(line, now); });
}

void TextDevice::take(std::string_view line, std::int64_t now_ns) {
  last_line_ = Clock::now();
  // The end of a line may look like a whole one, with other numbers; a header is what it is.
  if (std::exchange(midway_, false) && !is_header(split(line, separator_of(line)))) return;
  heard_.push_back({std::string(line), now_ns});
}

void TextDevice::deliver(plugin::Samples& samples) {
  std::vector<ArrivedRow> rows;
  for (const ArrivedLine& line : std::exchange(heard_, {})) {
    auto read = rows_->read(line.text);
    if (auto* const row = std::get_if<TextRow>(&read)) {
      rows.push_back({std::move(*row), line.host_time_ns});
    } else if (std::get<NoRow>(read) == NoRow::kBadChecksum) {
      samples.refuse(0, plugin::Reason::kChecksum);
    } else if (std::get<NoRow>(read) == NoRow::kMalformed) {
      samples.refuse(0, plugin::Reason::kMalformed);
    }
  }
  spread_in_time(rows, 1e9 / stream_.nominal_rate_hz);
  for (const ArrivedRow& one : rows) add(one, samples);
}

void TextDevice::add(const ArrivedRow& one, plugin::Samples& samples) {
  last_host_ns_ = std::max(last_host_ns_, one.host_time_ns);
  const std::optional<std::int64_t>& time = one.row.time_ns;
  if (time && last_time_ns_ && *time < *last_time_ns_ - kRestart)
    flags_ |= IMUNOISE_SAMPLE_AFTER_RESTART;
  last_time_ns_ = time;
  plugin::Row row = samples.add(
      0, {last_host_ns_, one.row.counter.value_or(0), time.value_or(0), std::exchange(flags_, 0U)});
  for (std::size_t c = 0; c < one.row.values.size(); ++c) {
    if (one.row.values[c]) {
      row.set(c, *one.row.values[c]);
    } else {
      row.refuse(c, plugin::Reason::kFault);
    }
  }
}

}  // namespace imunoise::text
