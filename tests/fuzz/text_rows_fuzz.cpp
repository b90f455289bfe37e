// Any bytes as the lines of a device: the first says what the columns are, the others are rows,
// the same whatever the pieces; no row has more values than columns.

#include <cstdlib>

#include "drivers/text/codec/lines.h"
#include "drivers/text/codec/row.h"

using namespace imunoise;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::string> lines;
  const auto take = [&lines](std::string_view line) { lines.emplace_back(line); };
  text::LineReader whole;
  whole.push({data, size}, take);
  const std::vector<std::string> expected = std::exchange(lines, {});
  text::LineReader cut;
  const std::size_t half = size / 2;
  cut.push({data, half}, take);
  cut.push({data + half, size - half}, take);
  if (lines != expected || cut.rest() != whole.rest()) std::abort();
  if (lines.empty()) return 0;
  const text::Separator separator = text::separator_of(lines[0]);
  const auto columns = text::parse_columns(text::split(lines[0], separator));
  if (!columns) return 0;
  text::LineForm form{.prefix = "", .checksum = size % 2 == 1};
  if (size % 3 == 0) form.time_maximum = 65535.0;
  text::RowReader rows(*columns, separator, form);
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const auto row = rows.read(lines[i]);
    if (const auto* const read = std::get_if<text::TextRow>(&row);
        read != nullptr && read->values.size() > columns->size())
      std::abort();
  }
  return 0;
}
