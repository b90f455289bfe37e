#include "recording/import/text/text_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <set>
#include <utility>

#include "core/support/utf8.h"
#include "recording/import/table/array_columns.h"
#include "recording/import/table/format.h"
#include "recording/import/table/names.h"
#include "recording/import/table/select.h"
#include "recording/import/table/time_names.h"
#include "recording/import/text/labels.h"
#include "recording/import/text/number.h"
#include "recording/import/text/text_layout.h"
#include "recording/import/text/text_rows.h"

namespace imunoise::recording {
namespace {

constexpr std::array kTextExtensions = {".csv", ".tsv", ".txt", ".dat"};

// Many control characters that no text has; a NUL byte may be half of a UTF-16 character.
bool is_binary(std::string_view head) {
  constexpr double kMany = 0.02;
  constexpr std::string_view kOfText = "\t\n\v\f\r\x1a\x1b";
  const bool wide = head.starts_with("\xff\xfe") || head.starts_with("\xfe\xff");
  const auto controls = std::count_if(head.begin(), head.end(), [&](char c) {
    const bool control = static_cast<unsigned char>(c) < 0x20;
    return control && !(wide && c == '\0') && kOfText.find(c) == std::string_view::npos;
  });
  return static_cast<double>(controls) > kMany * static_cast<double>(head.size());
}

Result<bool> claims_text(const UnknownFile& file) {
  const bool named = std::any_of(kTextExtensions.begin(), kTextExtensions.end(),
                                 [&](const char* known) { return file.extension == known; });
  if (!is_binary(file.head)) return true;
  if (!named) return false;
  return fail(fmt::format("{}: is no text, although its name ends in {}; export it again",
                          file.content.name(), file.extension.string()));
}

struct Head {
  TextHead text;
  std::vector<std::string> labels;  // that stand before each number of a row; empty: none do
  std::optional<double> rate;       // stated by a comment, Hz
};

// What begins a comment; 0 characters where none does. "%time" is a name of ROS.
std::size_t comment_mark(std::string_view text) {
  if (text.starts_with("//") || text.starts_with("% ") || text.starts_with("%%")) return 2;
  return text.starts_with('#') || text == "%" ? 1 : 0;
}

bool holds_no_samples(std::string_view line) {
  const std::string_view text = trim(line);
  return text.empty() || comment_mark(text) > 0;
}

// "rate_hz: 100" or "rate_hz = 100"
std::optional<double> rate_in_comment(std::string_view comment) {
  constexpr std::string_view key = "rate_hz";
  comment = trim(comment);
  if (!comment.starts_with(key)) return std::nullopt;
  comment = trim(comment.substr(key.size()));
  if (comment.empty() || (comment.front() != ':' && comment.front() != '=')) return std::nullopt;
  double value = 0.0;
  if (!is_number(trim(comment.substr(1)), value)) return std::nullopt;
  return value;
}

void read_up_to(std::size_t rows, LineReader& lines, Head& head) {
  while (head.text.rows.size() < rows) {
    const std::optional<std::string_view> line = lines.next();
    if (!line) break;
    if (!holds_no_samples(*line)) {
      head.text.rows.push_back({lines.line_number(), as_utf8(*line)});
    } else if (head.text.rows.empty() && !trim(*line).empty()) {
      const std::string_view comment = trim(*line);
      head.text.last_comment = as_utf8(trim(comment.substr(comment_mark(comment))));
      if (!head.rate) head.rate = rate_in_comment(head.text.last_comment);
    }
  }
}

Head read_head(LineReader& lines, const std::string& file, const ImportOptions& options) {
  Head head;
  head.text.file = file;
  read_up_to(kHeadRows, lines, head);
  const bool labview =
      !head.text.rows.empty() && head.text.rows.front().text.starts_with("LabVIEW Measurement");
  if (labview || !have_one_shape(head.text.rows) || hold_few_numbers(head.text.rows))
    read_up_to(kPreambleRows, lines, head);
  if (!options.delimiter && !options.header) head.labels = name_by_labels(head.text.rows);
  return head;
}

// Which columns are kept, and which one of them is the time.
struct Plan {
  std::vector<std::size_t> channels;  // in the order wanted
  std::optional<std::size_t> time;
  std::optional<std::size_t> nanoseconds;  // that are added to times of whole seconds
  std::optional<std::size_t> may_be_time;  // if it rises steadily
  std::vector<bool> wanted;                // one a column
  std::vector<std::string> notes;
};

// Columns whose first rows hold text: names of frames, states.
std::vector<bool> columns_of_text(const TextHead& head, const TextLayout& layout) {
  std::vector<bool> out(layout.columns.size(), false);
  for (std::size_t r = layout.header_rows; r < head.rows.size(); ++r) {
    const std::vector<std::string> fields = split_fields(head.rows[r].text, layout.delimiter);
    if (fields.size() != out.size()) continue;
    for (std::size_t c = 0; c < out.size(); ++c)
      out[c] = out[c] || !(is_missing(fields[c]) || is_numeric(fields[c]));
  }
  return out;
}

bool is_of_motion(const HeaderField& column) {
  const Result<Unit> unit = parse_unit(column.unit);
  return of_inertia(role_of(column.name).quantity) || (unit && of_inertia(unit->quantity));
}

// "gyro", "acc", "gyro_x": a word that says which sensor a row is of.
bool is_sensor(const std::string& word) {
  return of_inertia(role_of(word).quantity) || of_inertia(role_of(word + "_x").quantity);
}

// Sensors by turns in a column of words: one table would mix them.
Result<void> one_sensor_a_row(const TextHead& head, const TextLayout& layout,
                              const std::vector<bool>& text) {
  for (std::size_t c = 0; c < layout.columns.size(); ++c) {
    std::set<std::string> named;
    for (std::size_t r = layout.header_rows; text[c] && r < head.rows.size(); ++r) {
      const auto fields = split_fields(head.rows[r].text, layout.delimiter);
      if (fields.size() == layout.columns.size() && is_sensor(fields[c])) named.insert(fields[c]);
    }
    if (named.size() < 2) continue;
    return fail(
        fmt::format("{}: column {} names the sensor of each row ({}, {}); save the rows of each "
                    "sensor in its own file",
                    head.file, layout.columns[c].name, *named.begin(), *std::next(named.begin())));
  }
  return {};
}

constexpr const char* kHoldsTimes = "holds times";

// Why a column is no channel unless it is asked for; empty: it is one. `others`: there are channels
// of motion.
std::string why_left_out(const HeaderField& column, bool text, bool others) {
  if (text) return "holds text";
  if (is_counter_name(column.name)) return "counts";
  if (is_norm_name(column.name)) return "is the length of a vector";
  const bool unit = !column.unit.empty() && column.unit != "-" && !parse_unit(column.unit);
  if (!unit || !others || role_of(column.name).quantity != Quantity::kUnknown) return "";
  return time_unit("", column.unit) ? kHoldsTimes
                                    : fmt::format("is in {}, which is no unit here", column.unit);
}

// Nanoseconds that belong to the seconds of another column.
bool is_part_of_a_time(const TextLayout& layout, std::size_t column) {
  const auto stem = stem_of_nanoseconds(layout.columns[column].name);
  return stem && std::any_of(layout.columns.begin(), layout.columns.end(),
                             [&](const auto& one) { return stem_of_seconds(one.name) == stem; });
}

// The stamp of the measurement rather than that of the file that holds it.
std::optional<std::size_t> time_of(const TextLayout& layout) {
  std::optional<std::size_t> first;
  for (std::size_t c = 0; c < layout.columns.size(); ++c) {
    const std::string& name = layout.columns[c].name;
    if (!is_time_name(name) || is_part_of_a_time(layout, c)) continue;
    if (name.find("header") != std::string::npos) return c;
    if (!first) first = c;
  }
  return first;
}

// "stamp.nanosec" beside "stamp.sec".
std::optional<std::size_t> nanoseconds_of(const TextLayout& layout, std::size_t time) {
  const auto stem = stem_of_seconds(layout.columns[time].name);
  for (std::size_t c = 0; c < layout.columns.size() && stem; ++c) {
    if (c != time && stem_of_nanoseconds(layout.columns[c].name) == stem) return c;
  }
  return std::nullopt;
}

// Whether a column without the name of a time may be one all the same.
bool may_be_time(const HeaderField& column) {
  return column.unit.empty() || column.unit == "-" || time_unit("", column.unit);
}

// The first column whose first rows are dates and times that go on. A first column of rising
// numbers may be a better clock.
std::optional<std::size_t> calendar_of(const TextHead& head, const TextLayout& layout) {
  std::vector<std::vector<std::int64_t>> times(layout.columns.size());
  std::vector<double> first;
  for (std::size_t r = layout.header_rows; r < head.rows.size(); ++r) {
    const std::vector<std::string> fields = split_fields(head.rows[r].text, layout.delimiter);
    if (fields.size() != times.size()) return std::nullopt;
    for (std::size_t c = 0; c < times.size(); ++c) {
      if (const auto time = read_calendar(fields[c])) times[c].push_back(*time);
    }
    double number = 0.0;
    if (is_number(fields.front(), number)) first.push_back(number);
  }
  const std::size_t rows = head.rows.size() - layout.header_rows;
  const bool rises =
      first.size() == rows && rows > 1 &&
      std::adjacent_find(first.begin(), first.end(), std::greater_equal<>()) == first.end();
  if (rises && may_be_time(layout.columns.front())) return std::nullopt;
  const auto goes_on = [&](const std::vector<std::int64_t>& all) {
    return all.size() == rows && rows > 1 && all.front() != all.back();
  };
  const auto found = std::find_if(times.begin(), times.end(), goes_on);
  if (found == times.end()) return std::nullopt;
  return static_cast<std::size_t>(found - times.begin());
}

Result<Plan> make_plan(const TextHead& head, const TextLayout& layout, bool stated_rate,
                       const ImportOptions& options) {
  Plan plan;
  plan.notes = layout.notes;
  std::vector<Offer> offers;
  const std::vector<bool> text = columns_of_text(head, layout);
  std::optional<std::size_t> time = time_of(layout);
  if (!time && !stated_rate) time = calendar_of(head, layout);
  if (auto one = one_sensor_a_row(head, layout, text); !one)
    return tl::make_unexpected(one.error());
  const bool others =
      !options.beside && std::any_of(layout.columns.begin(), layout.columns.end(), is_of_motion);
  for (std::size_t c = 0; c < layout.columns.size(); ++c) {
    const HeaderField& column = layout.columns[c];
    const bool channel = !is_time_name(column.name) && !layout.unnamed[c] && c != time;
    const std::string why = channel ? why_left_out(column, text[c], others) : std::string();
    offers.push_back({column.name, channel && why.empty(), column.unit});
    const bool the_time = c == 0 && !time && !stated_rate && why == kHoldsTimes;
    if (!why.empty() && !the_time)
      plan.notes.push_back(fmt::format("column {} {}: left out", column.name, why));
  }
  Result<std::vector<std::size_t>> channels = select_columns(head.file, offers, options);
  if (!channels) return tl::make_unexpected(channels.error());
  plan.channels = std::move(*channels);
  plan.wanted.assign(offers.size(), false);
  for (const std::size_t c : plan.channels) plan.wanted[c] = true;
  if (options.rate) return plan;
  plan.time = time;
  if (plan.time) {
    plan.wanted[*plan.time] = false;
    plan.nanoseconds = nanoseconds_of(layout, *plan.time);
    if (plan.nanoseconds && plan.wanted[*plan.nanoseconds]) plan.nanoseconds.reset();  // a channel
    if (plan.nanoseconds) plan.wanted[*plan.nanoseconds] = true;
  } else if (!text.front() && !layout.unnamed.front() && !stated_rate &&
             may_be_time(layout.columns.front())) {
    plan.may_be_time = 0;
    plan.wanted.front() = true;
  }
  return plan;
}

// Parses the rows of the head and then the rest of the file.
Result<void> read_rows(const File& file, const Head& head, std::size_t header_rows,
                       LineReader& lines, RowParser& rows, FileProgress& progress) {
  for (std::size_t i = header_rows; i < head.text.rows.size(); ++i) {
    if (auto error = rows.add(head.text.rows[i].text, head.text.rows[i].line)) {
      return tl::make_unexpected(std::move(*error));
    }
  }
  constexpr std::size_t rows_between_reports = 1U << 16U;
  std::size_t next_estimate = 1024;
  while (const std::optional<std::string_view> line = lines.next()) {
    constexpr std::string_view kSuspect = "#%/ \t";
    const bool suspect = line->empty() || kSuspect.find(line->front()) != std::string_view::npos;
    if (suspect && holds_no_samples(*line)) continue;
    const std::string bare = head.labels.empty() ? "" : without_labels(*line, head.labels);
    if (auto error = rows.add(head.labels.empty() ? *line : bare, lines.line_number())) {
      return tl::make_unexpected(std::move(*error));
    }
    if (rows.rows() == next_estimate) {
      const double done = static_cast<double>(lines.bytes_done());
      const double whole = static_cast<double>(std::max(file.size(), lines.bytes_done()));
      // Room for the rows to come, from the mean length of those seen: growing by doubling would
      // hold the numbers three times over.
      rows.reserve(
          static_cast<std::size_t>(1.02 * whole / done * static_cast<double>(next_estimate)),
          rows_between_reports);
      progress.report(done / whole);
      if (progress.stopped()) return fail(fmt::format("{}: the import was stopped", file.name()));
      next_estimate = next_estimate < rows_between_reports ? rows_between_reports
                                                           : next_estimate + rows_between_reports;
    }
  }
  if (lines.error()) return tl::make_unexpected(*lines.error());
  return {};
}

// Times of whole seconds and of nanoseconds, in ns.
TimeColumn joined_times(const TextLayout& layout, const Plan& plan, RowParser& rows) {
  const HeaderField& column = layout.columns[*plan.time];
  TimeColumn out{column.name, column.unit, rows.take_stamps(), rows.calendar()};
  auto* const seconds = std::get_if<std::vector<std::int64_t>>(&out.stamps);
  if (!plan.nanoseconds || seconds == nullptr || out.calendar) return out;
  constexpr std::int64_t most = std::int64_t{1} << 33U;  // s; more is no time since 1970
  const std::vector<double> parts = rows.take(*plan.nanoseconds);
  for (std::size_t i = 0; i < seconds->size(); ++i) {
    const bool whole = parts[i] >= 0.0 && parts[i] < 1e9 && std::abs((*seconds)[i]) < most;
    if (!whole) return out;
  }
  for (std::size_t i = 0; i < seconds->size(); ++i)
    (*seconds)[i] = (*seconds)[i] * 1'000'000'000 + static_cast<std::int64_t>(parts[i]);
  out.name += " and " + layout.columns[*plan.nanoseconds].name;
  out.unit = "ns";
  return out;
}

// The column of times; or the first column, if it rises steadily, else a channel like the others.
void take_time(const TextLayout& layout, const Plan& plan, RowParser& rows, Table& to) {
  if (plan.time) to.time = joined_times(layout, plan, rows);
  if (!plan.may_be_time) return;
  const std::size_t c = *plan.may_be_time;
  const HeaderField& column = layout.columns[c];
  std::vector<double> values = rows.take(c);
  if (rises_steadily(values)) {
    to.notes.push_back(fmt::format("column {} rises steadily: it is the time", column.name));
    const bool named = column.unit.empty() && time_unit("", column.name);  // "hours"
    const std::string unit = named ? column.name : column.unit;
    to.time = TimeColumn{column.name, unit == "-" ? "" : unit, std::move(values)};
    return;
  }
  const auto wanted = std::find(plan.channels.begin(), plan.channels.end(), c);
  if (wanted == plan.channels.end()) return;
  to.columns.insert(to.columns.begin() + (wanted - plan.channels.begin()),
                    {column.name, std::move(values), 1.0, 0.0, column.unit});
}

}  // namespace

Result<Table> read_text_table(const std::filesystem::path& path, const ImportOptions& options,
                              FileProgress& progress, std::size_t block_bytes) {
  const Result<File> file = File::open(path);
  if (!file) return tl::make_unexpected(file.error());
  LineReader lines(*file, block_bytes);
  const Head head = read_head(lines, file->name(), options);
  if (lines.error()) return tl::make_unexpected(*lines.error());
  const Result<TextLayout> layout = detect_layout(head.text, options);
  if (!layout) return tl::make_unexpected(layout.error());
  Result<Plan> plan = make_plan(head.text, *layout, head.rate.has_value(), options);
  if (!plan) return tl::make_unexpected(plan.error());

  RowParser rows(file->name(), *layout, plan->wanted, plan->time);
  if (const Result<void> read = read_rows(*file, head, layout->header_rows, lines, rows, progress);
      !read) {
    return tl::make_unexpected(read.error());
  }

  Table table;
  if (!options.rate && head.rate && !plan->time) table.rate = {*head.rate, "the comment rate_hz"};
  for (const std::size_t c : plan->channels) {
    if (c == plan->may_be_time) continue;
    table.columns.push_back(
        {layout->columns[c].name, rows.take(c), 1.0, 0.0, layout->columns[c].unit});
  }
  take_time(*layout, *plan, rows, table);
  table.row = [map = rows.row_map()](std::size_t i) {
    return fmt::format("row {}", map.line_of(i));
  };
  table.notes.insert(table.notes.begin(), plan->notes.begin(), plan->notes.end());
  table.unreadable = rows.unreadable();
  table.first_unreadable = rows.first_unreadable();
  return table;
}

namespace formats {

const ImportFormat& text() {
  static constexpr ImportFormat kFormat = {
      .kind = "text (.csv, .tsv, .txt, .dat)",
      .claims = claims_text,
      .read = [](const std::filesystem::path& path, const ImportOptions& options,
                 FileProgress& progress) { return read_text_table(path, options, progress); }};
  return kFormat;
}

}  // namespace formats

}  // namespace imunoise::recording
