#include "recording/import/binary/binary_table.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "recording/import/table/array_columns.h"
#include "recording/import/table/select.h"

namespace imunoise::recording {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they lie");

constexpr std::size_t kBlock = std::size_t{1} << 20U;  // bytes

// What a column is called and means.
struct Meaning {
  std::string name;
  std::string unit;
  double scale = 1.0;
  double offset = 0.0;
};

Result<std::vector<Meaning>> meanings(const File& file, std::size_t columns,
                                      const std::optional<v1::Sidecar>& sidecar) {
  std::vector<Meaning> out;
  if (columns > kMaximumColumns) {
    return fail(fmt::format("{}: {} columns, more than the {} allowed; is the array transposed?",
                            file.name(), columns, kMaximumColumns));
  }
  if (!sidecar || sidecar->channels().empty()) {
    for (std::size_t c = 1; c <= columns; ++c) out.push_back({fmt::format("col{}", c), ""});
    return out;
  }
  if (static_cast<std::size_t>(sidecar->channels_size()) != columns) {
    return fail(fmt::format("{}: {} columns, but {}.json names {} channels; correct the sidecar",
                            file.name(), columns, file.name(), sidecar->channels_size()));
  }
  for (const v1::SidecarChannel& channel : sidecar->channels()) {
    out.push_back({channel.name(), channel.units(),
                   channel.has_scale_factor() ? channel.scale_factor() : 1.0,
                   channel.add_offset()});
  }
  return out;
}

// Appends `count` numbers that lie `stride` bytes apart.
template <class Stored, class Kept>
void append(const char* from, std::size_t stride, std::size_t count, std::vector<Kept>& to) {
  const std::size_t old = to.size();
  to.resize(old + count);
  for (std::size_t i = 0; i < count; ++i) {
    Stored number;
    std::memcpy(&number, from + i * stride, sizeof(Stored));
    to[old + i] = number;
  }
}

struct Source {
  const File& file;
  const BinaryLayout& layout;
  const std::vector<std::size_t>& wanted;
  FileProgress& progress;
};

// Reads blocks of whole rows (of one column's numbers when column_major) and picks the wanted ones.
template <class Stored, class Kept>
Result<std::vector<Samples>> read_as(const Source& source) {
  const BinaryLayout& layout = source.layout;
  const std::size_t passes = layout.column_major ? source.wanted.size() : 1;
  const std::size_t row_bytes = sizeof(Stored) * (layout.column_major ? 1 : layout.columns);
  const std::size_t block_rows = std::max<std::size_t>(1, kBlock / row_bytes);
  std::vector<std::vector<Kept>> columns(source.wanted.size());
  for (auto& column : columns) column.reserve(layout.rows);
  std::vector<char> block(std::min(block_rows, layout.rows) * row_bytes);
  for (std::size_t pass = 0; pass < passes; ++pass) {
    const std::size_t first = layout.column_major ? source.wanted[pass] * layout.rows : 0;
    for (std::size_t row = 0; row < layout.rows; row += block_rows) {
      const std::size_t rows = std::min(block_rows, layout.rows - row);
      const std::span<char> bytes = std::span(block).first(rows * row_bytes);
      const Result<std::size_t> got =
          source.file.read_at(layout.begin + first * sizeof(Stored) + row * row_bytes, bytes);
      if (!got) return tl::make_unexpected(got.error());
      if (*got != bytes.size()) {
        return fail(
            fmt::format("{}: became shorter while it was read; read it again when its "
                        "writer has finished",
                        source.file.name()));
      }
      const std::size_t begin = layout.column_major ? pass : 0;
      const std::size_t end = layout.column_major ? pass + 1 : columns.size();
      for (std::size_t k = begin; k < end; ++k) {
        const std::size_t shift = layout.column_major ? 0 : source.wanted[k] * sizeof(Stored);
        append<Stored>(block.data() + shift, row_bytes, rows, columns[k]);
      }
      source.progress.report((static_cast<double>(pass) +
                              static_cast<double>(row + rows) / static_cast<double>(layout.rows)) /
                             static_cast<double>(passes));
      if (source.progress.stopped()) {
        return fail(fmt::format("{}: the import was stopped", source.file.name()));
      }
    }
  }
  return std::vector<Samples>(std::make_move_iterator(columns.begin()),
                              std::make_move_iterator(columns.end()));
}

// Makes the first of several columns the time if it rises steadily.
bool take_time(Table& table, const ImportOptions& options) {
  if (table.columns.size() < 2 || !options.channels.empty()) return false;
  Column& first = table.columns.front();
  auto* const numbers = std::get_if<std::vector<double>>(&first.samples);
  if (numbers == nullptr || !rises_steadily(*numbers)) return false;
  table.notes.push_back(fmt::format("time: {}, because it rises steadily", first.name));
  table.time = TimeColumn{first.name, first.unit, std::move(*numbers)};
  table.columns.erase(table.columns.begin());
  return true;
}

Result<std::vector<Samples>> read_numbers(const Source& source) {
  switch (source.layout.type) {
    case NumberType::kInt16:
      return read_as<std::int16_t, std::int16_t>(source);
    case NumberType::kInt32:
      return read_as<std::int32_t, std::int32_t>(source);
    case NumberType::kFloat32:
      return read_as<float, double>(source);
    case NumberType::kFloat64:
      break;
  }
  return read_as<double, double>(source);
}

}  // namespace

std::size_t width(NumberType type) {
  switch (type) {
    case NumberType::kInt16:
      return 2;
    case NumberType::kInt32:
    case NumberType::kFloat32:
      return 4;
    case NumberType::kFloat64:
      break;
  }
  return 8;
}

std::optional<NumberType> number_type(std::string_view dtype) {
  if (dtype == "<i2") return NumberType::kInt16;
  if (dtype == "<i4") return NumberType::kInt32;
  if (dtype == "<f4") return NumberType::kFloat32;
  if (dtype == "<f8") return NumberType::kFloat64;
  return std::nullopt;
}

Result<Table> read_binary_table(const File& file, const BinaryLayout& layout,
                                const std::optional<v1::Sidecar>& sidecar,
                                const ImportOptions& options, FileProgress& progress) {
  Table table;
  const bool stated = sidecar && sidecar->rate_hz() > 0.0;
  if (!options.rate && stated) table.rate = {sidecar->rate_hz(), "rate_hz of the sidecar"};
  table.row = [](std::size_t i) { return fmt::format("sample {}", i); };
  const Result<std::vector<Meaning>> meaning = meanings(file, layout.columns, sidecar);
  if (!meaning) return tl::make_unexpected(meaning.error());
  std::vector<Offer> offers;
  for (const Meaning& column : *meaning) offers.push_back({column.name, true, column.unit});
  const auto wanted = select_columns(file.name(), offers, options);
  if (!wanted) return tl::make_unexpected(wanted.error());
  for (const std::size_t c : *wanted) {
    const Meaning& column = (*meaning)[c];
    table.columns.push_back({column.name, {}, column.scale, column.offset, column.unit});
  }
  Result<std::vector<Samples>> samples = read_numbers({file, layout, *wanted, progress});
  if (!samples) return tl::make_unexpected(samples.error());
  for (std::size_t k = 0; k < samples->size(); ++k) {
    table.columns[k].samples = std::move((*samples)[k]);
  }
  if (options.rate || stated || take_time(table, options)) return table;
  return fail(fmt::format("{}: no sampling rate; give it with --rate HZ or as rate_hz in {}.json",
                          file.name(), file.name()));
}

}  // namespace imunoise::recording
