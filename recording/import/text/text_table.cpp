#include "recording/import/text/text_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>

#include "recording/import/table/format.h"
#include "recording/import/table/names.h"
#include "recording/import/table/select.h"
#include "recording/import/text/number.h"
#include "recording/import/text/text_layout.h"
#include "recording/import/text/text_rows.h"

namespace imunoise::recording {
namespace {

constexpr std::array kTextExtensions = {".csv", ".tsv", ".txt", ".dat"};

Result<bool> claims_text(const UnknownFile& file) {
  return file.head.find('\0') == std::string_view::npos ||
         std::any_of(kTextExtensions.begin(), kTextExtensions.end(),
                     [&](const char* known) { return file.extension == known; });
}

struct Head {
  TextHead text;
  std::optional<double> rate;  // stated by a comment, Hz
};

bool holds_no_samples(std::string_view line) {
  const std::string_view text = trim(line);
  return text.empty() || text.front() == '#';
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

Head read_head(LineReader& lines, const std::string& file) {
  Head head;
  head.text.file = file;
  while (head.text.rows.size() < kHeadRows) {
    const std::optional<std::string_view> line = lines.next();
    if (!line) break;
    if (!holds_no_samples(*line)) {
      head.text.rows.push_back({lines.line_number(), std::string(*line)});
    } else if (head.text.rows.empty() && !trim(*line).empty()) {
      head.text.last_comment = trim(*line).substr(1);
      if (!head.rate) head.rate = rate_in_comment(head.text.last_comment);
    }
  }
  return head;
}

// Which columns are kept, and which one of them is the time.
struct Plan {
  std::vector<std::size_t> channels;  // in the order wanted
  std::optional<std::size_t> time;
  std::vector<bool> wanted;  // one a column
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

// The stamp of the measurement rather than that of the file that holds it.
std::optional<std::size_t> time_of(const TextLayout& layout) {
  std::optional<std::size_t> first;
  for (std::size_t c = 0; c < layout.columns.size(); ++c) {
    const std::string& name = layout.columns[c].name;
    if (!is_time_name(name)) continue;
    if (name.find("header") != std::string::npos) return c;
    if (!first) first = c;
  }
  return first;
}

Result<Plan> make_plan(const TextHead& head, const TextLayout& layout,
                       const ImportOptions& options) {
  Plan plan;
  std::vector<Offer> offers;
  const std::vector<bool> text = columns_of_text(head, layout);
  for (std::size_t c = 0; c < layout.columns.size(); ++c) {
    const HeaderField& column = layout.columns[c];
    const bool channel = !is_time_name(column.name) && !layout.unnamed[c];
    offers.push_back({column.name, channel && !text[c], column.unit});
    if (channel && text[c])
      plan.notes.push_back(fmt::format("column {} holds text: left out", column.name));
  }
  Result<std::vector<std::size_t>> channels = select_columns(head.file, offers, options);
  if (!channels) return tl::make_unexpected(channels.error());
  plan.channels = std::move(*channels);
  plan.wanted.assign(offers.size(), false);
  for (const std::size_t c : plan.channels) plan.wanted[c] = true;
  if (!options.rate) plan.time = time_of(layout);
  if (plan.time) plan.wanted[*plan.time] = false;
  return plan;
}

// Parses the rows of the head and then the rest of the file.
Result<void> read_rows(const File& file, const TextHead& head, std::size_t header_rows,
                       LineReader& lines, RowParser& rows, FileProgress& progress) {
  for (std::size_t i = header_rows; i < head.rows.size(); ++i) {
    if (auto error = rows.add(head.rows[i].text, head.rows[i].line)) {
      return tl::make_unexpected(std::move(*error));
    }
  }
  constexpr std::size_t rows_between_reports = 1U << 16U;
  std::size_t next_estimate = 1024;
  while (const std::optional<std::string_view> line = lines.next()) {
    const char first = line->empty() ? '#' : line->front();
    const bool suspect = first == '#' || first == ' ' || first == '\t';
    if (suspect && holds_no_samples(*line)) continue;
    if (auto error = rows.add(*line, lines.line_number())) {
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

}  // namespace

Result<Table> read_text_table(const std::filesystem::path& path, const ImportOptions& options,
                              FileProgress& progress, std::size_t block_bytes) {
  const Result<File> file = File::open(path);
  if (!file) return tl::make_unexpected(file.error());
  LineReader lines(*file, block_bytes);
  const Head head = read_head(lines, file->name());
  if (lines.error()) return tl::make_unexpected(*lines.error());
  const Result<TextLayout> layout = detect_layout(head.text, options);
  if (!layout) return tl::make_unexpected(layout.error());
  Result<Plan> plan = make_plan(head.text, *layout, options);
  if (!plan) return tl::make_unexpected(plan.error());

  RowParser rows(file->name(), *layout, plan->wanted, plan->time);
  if (const Result<void> read =
          read_rows(*file, head.text, layout->header_rows, lines, rows, progress);
      !read) {
    return tl::make_unexpected(read.error());
  }

  Table table;
  if (plan->time) {
    const HeaderField& column = layout->columns[*plan->time];
    table.time = {column.name, column.unit, rows.take_stamps(), rows.calendar()};
  } else if (!options.rate && head.rate) {
    table.rate = {*head.rate, "the comment rate_hz"};
  }
  for (const std::size_t c : plan->channels) {
    table.columns.push_back(
        {layout->columns[c].name, rows.take(c), 1.0, 0.0, layout->columns[c].unit});
  }
  table.row = [map = rows.row_map()](std::size_t i) {
    return fmt::format("row {}", map.line_of(i));
  };
  table.notes = std::move(plan->notes);
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
