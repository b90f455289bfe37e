#include "recording/import/import.h"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <map>
#include <utility>

#include "core/support/counted.h"
#include "core/support/parallel.h"
#include "recording/import/packed/unpacked_file.h"
#include "recording/import/pieces.h"
#include "recording/import/preflight/preflight.h"
#include "recording/import/table/format.h"
#include "recording/import/table/select.h"
#include "recording/import/table/table.h"

namespace imunoise::recording {
namespace {

// Clocks of one kind of device differ by less; a wrong rate differs by more.
constexpr double kRateTolerance = 1e-3;

// Of what the preflight is to judge by, what is as long as the channels that are wanted.
void drop_other_lengths(std::size_t wanted, Table& table) {
  const std::size_t rows = size(table.columns.front().samples);
  const auto first = table.columns.begin() + static_cast<std::ptrdiff_t>(wanted);
  table.columns.erase(std::remove_if(first, table.columns.end(),
                                     [&](const Column& one) { return size(one.samples) != rows; }),
                      table.columns.end());
}

Result<void> check_lengths(const std::string& file, const Table& table) {
  const Column& first = table.columns.front();
  for (const Column& column : table.columns) {
    if (size(column.samples) != size(first.samples)) {
      return fail(fmt::format(
          "{}: channel {} has {} where {} has {}; read them separately with --channel", file,
          column.name, counted(size(column.samples), "sample"), first.name, size(first.samples)));
    }
  }
  if (!table.time || size(table.time->stamps) == size(first.samples)) return {};
  return fail(fmt::format("{}: {} has {} for {}; give --rate HZ to ignore them", file,
                          table.time->name, counted(size(table.time->stamps), "time"),
                          counted(size(first.samples), "sample")));
}

Result<Table> read_as_it_is(const std::filesystem::path& path, const ImportOptions& options,
                            FileProgress& progress) {
  const Result<const ImportFormat*> format = detect_format(path);
  if (!format) return tl::make_unexpected(format.error());
  return (*format)->read(path, options, progress);
}

// Names of the columns that are wanted; those behind them are to judge by.
Result<std::vector<std::string>> wanted_of(const std::string& file, const Table& table,
                                           ImportOptions options) {
  std::vector<Offer> offers;
  for (const Column& one : table.columns) offers.push_back({one.name});
  std::vector<std::string> out;
  if (options.axes_to_judge) {
    options.axes_to_judge = false;
    const auto wanted = select_columns(file, offers, options);
    if (!wanted) return tl::make_unexpected(wanted.error());
    for (const std::size_t c : *wanted) out.push_back(offers[c].name);
  } else {
    for (Offer& one : offers) out.push_back(std::move(one.name));
  }
  return out;
}

// Of a file, packed as a whole or not.
Result<Table> read_content(const std::filesystem::path& path, const ImportOptions& options,
                           FileProgress& progress) {
  const auto unpacked = UnpackedFile::of(path, [&] { return progress.stopped(); });
  if (!unpacked) return tl::make_unexpected(unpacked.error());
  if (!*unpacked) return read_as_it_is(path, options, progress);
  Result<Table> table = read_as_it_is((*unpacked)->path(), options, progress);
  if (!table) return fail((*unpacked)->in_users_words(table.error().message));
  table->truncated = table->truncated || (*unpacked)->truncated();
  return table;
}

// Puts what the next piece of a recording holds behind a table.
Result<void> append(const std::filesystem::path& piece, Table next, Table& to) {
  const auto differ = [&](const std::string& how) {
    return fail(
        fmt::format("{}: {} than the pieces before; choose with --topic or --channel, or "
                    "read it by itself",
                    piece.string(), how));
  };
  if (next.columns.size() != to.columns.size() || next.time.has_value() != to.time.has_value())
    return differ("has other channels");
  for (std::size_t c = 0; c < to.columns.size(); ++c) {
    Column& first = to.columns[c];
    Column& second = next.columns[c];
    if (first.name != second.name || first.unit != second.unit || first.scale != second.scale ||
        first.samples.index() != second.samples.index())
      return differ("has other channels");
    std::visit(
        [&](auto& values) {
          auto& more = std::get<std::decay_t<decltype(values)>>(second.samples);
          values.insert(values.end(), more.begin(), more.end());
          more = {};
        },
        first.samples);
  }
  if (to.time) {
    if (to.time->stamps.index() != next.time->stamps.index()) return differ("has other times");
    std::visit(
        [&](auto& values) {
          auto& more = std::get<std::decay_t<decltype(values)>>(next.time->stamps);
          values.insert(values.end(), more.begin(), more.end());
        },
        to.time->stamps);
  }
  to.unreadable += next.unreadable;
  if (to.first_unreadable.empty()) to.first_unreadable = std::move(next.first_unreadable);
  to.truncated = to.truncated || next.truncated;
  return {};
}

// Of a bag in a folder: its pieces, one behind the other.
Result<Table> read_pieces(const std::filesystem::path& folder,
                          const std::vector<std::filesystem::path>& pieces,
                          const ImportOptions& options, FileProgress& progress) {
  std::optional<Table> out;
  for (const std::filesystem::path& piece : pieces) {
    const Progress stopping = progress.only_stopping();
    std::atomic<double> ignored = 0.0;
    FileProgress own(stopping, ignored, 1);
    Result<Table> table = read_content(piece, options, own);
    if (!table) return table;
    if (!out) {
      out = std::move(*table);
    } else if (auto done = append(piece, std::move(*table), *out); !done) {
      return tl::make_unexpected(done.error());
    }
    progress.report(static_cast<double>(&piece - pieces.data() + 1) /
                    static_cast<double>(pieces.size()));
  }
  out->notes.push_back(fmt::format("{} of {}", counted(pieces.size(), "file"), folder.string()));
  return std::move(*out);
}

Result<Judged> read_table(const std::filesystem::path& path, const ImportOptions& options,
                          FileProgress& progress) {
  const std::vector<std::filesystem::path> pieces = pieces_of(path);
  Result<Table> table = pieces.empty() ? read_content(path, options, progress)
                                       : read_pieces(path, pieces, options, progress);
  if (!table) return tl::make_unexpected(table.error());
  const auto wanted = wanted_of(path.string(), *table, options);
  if (!wanted) return tl::make_unexpected(wanted.error());
  drop_other_lengths(wanted->size(), *table);
  if (auto even = check_lengths(path.string(), *table); !even)
    return tl::make_unexpected(even.error());
  return judge(path.string(), std::move(*table), *wanted, options);
}

// The edge where exceptions of libraries (no memory above all) become errors.
Result<Judged> read_table_safely(const std::filesystem::path& path, const ImportOptions& options,
                                 FileProgress& progress) {
  try {
    Result<Judged> table = read_table(path, options, progress);
    progress.report(1.0);
    return table;
  } catch (const std::exception& error) {
    return fail(fmt::format("{}: cannot be read: {}", path.string(), error.what()));
  }
}

// Each stretch gives split_into replicates.
Result<void> check_parts(const std::string& file, const Judged& table, std::size_t split_into) {
  std::size_t each = 0;
  for (const Stretch& one : table.stretches) each = std::max(each, one.count / split_into);
  if (each >= kMinimumSamples) return {};
  return fail(
      fmt::format("{}: {} in each of {} parts: too few, a replicate needs at least {}; record "
                  "longer or split into fewer",
                  file, counted(each, "sample"), split_into, kMinimumSamples));
}

// Files are replicates of one another only when they measure the same.
Result<void> check_agreement(const std::string& first_file, const Judged& first,
                             const std::string& file, const Judged& table) {
  if (std::abs(table.rate.value / first.rate.value - 1.0) > kRateTolerance) {
    return fail(
        fmt::format("{}: sampled at {} Hz, but {} at {} Hz; import them separately, or state the "
                    "true rate with --rate HZ",
                    file, table.rate.value, first_file, first.rate.value));
  }
  const auto named = [](const std::string& name) {
    return [&name](const Column& column) { return column.name == name; };
  };
  for (const Column& column : first.columns) {
    const auto found = std::find_if(table.columns.begin(), table.columns.end(), named(column.name));
    if (found == table.columns.end()) {
      return fail(
          fmt::format("{}: no channel '{}', which {} has; choose common ones with --channel", file,
                      column.name, first_file));
    }
    const Unit& unit = table.units[static_cast<std::size_t>(found - table.columns.begin())];
    const Unit& first_unit = first.units[static_cast<std::size_t>(&column - first.columns.data())];
    if (unit.symbol != first_unit.symbol) {
      return fail(fmt::format(
          "{}: channel {} is in {}, but in {} it is in {}; import them separately, or state "
          "the true unit with --unit",
          file, column.name, unit.symbol, first_file, first_unit.symbol));
    }
  }
  for (const Column& column : table.columns) {
    if (std::any_of(first.columns.begin(), first.columns.end(), named(column.name))) continue;
    return fail(
        fmt::format("{}: has channel '{}', which {} has not; choose common ones with --channel",
                    file, column.name, first_file));
  }
  return {};
}

// "run1"; with its folder where two files share a name.
std::vector<std::string> replicate_names(std::span<const std::filesystem::path> paths) {
  const auto without_slash = [](const std::filesystem::path& path) {
    return path.has_filename() ? path : path.parent_path();
  };
  std::map<std::string, int> stems;
  for (const auto& path : paths) ++stems[without_slash(path).stem().string()];
  std::map<std::string, int> seen;
  std::vector<std::string> names;
  for (const auto& given : paths) {
    const std::filesystem::path path = without_slash(given);
    std::string name = path.stem().string();
    if (stems[name] > 1) name = (path.parent_path().filename() / path.filename()).string();
    const int repeat = ++seen[name];
    names.push_back(repeat > 1 ? fmt::format("{} ({})", name, repeat) : name);
  }
  return names;
}

// Cuts a table into replicates that share its samples.
void add_replicates(const std::filesystem::path& path, const std::string& name, Hertz rate,
                    Judged table, std::size_t split_into, std::vector<Replicate>& out) {
  std::vector<Stretch> parts;
  std::vector<Origin> origins;
  const std::size_t recording = out.empty() ? 0 : out.back().origin.recording + 1;
  for (const Stretch& stretch : table.stretches) {
    const std::size_t each = stretch.count / split_into;
    const Origin begins = origin_at(recording, stretch.seconds * rate.value);
    for (std::size_t i = 0; i < split_into && each >= kMinimumSamples; ++i) {
      parts.push_back({stretch.begin + i * each, each});
      origins.push_back({recording, begins.first + i * each});
    }
  }
  const std::size_t first = out.size();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    out.push_back({parts.size() > 1 ? fmt::format("{}#{}", name, i + 1) : name,
                   path,
                   rate,
                   {},
                   {.jitter = table.jitter},
                   table.report,
                   origins[i]});
  }
  out[first].timing.gaps = table.gaps;
  out[first].timing.lost = table.lost;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    Column& column = table.columns[c];
    const Unit& unit = table.units[c];
    const auto samples = std::make_shared<const Samples>(std::move(column.samples));
    for (std::size_t i = 0; i < parts.size(); ++i) {
      out[first + i].channels.push_back({column.name, samples, parts[i].begin, parts[i].count,
                                         column.scale * unit.to_si,
                                         column.offset * unit.to_si + unit.si_offset, unit, rate});
    }
  }
}

Result<void> check_options(std::span<const std::filesystem::path> paths,
                           const ImportOptions& options) {
  if (paths.empty()) return fail("no file is named; name at least one");
  if (options.from && options.until && *options.from >= *options.until)
    return fail(
        fmt::format("--from {:g} is not before --until {:g}", *options.from, *options.until));
  if (options.split_into == 0)
    return fail("cannot split into 0 replicates; --split-into starts at 1");
  if (options.rate && (!std::isfinite(options.rate->value) || options.rate->value <= 0.0)) {
    return fail(fmt::format("--rate {} is not a sampling rate; it must be positive, in Hz",
                            options.rate->value));
  }
  return {};
}

}  // namespace

Result<std::vector<Replicate>> import_files(std::span<const std::filesystem::path> paths,
                                            const ImportOptions& given, const Progress& progress) {
  ImportOptions options = given;
  options.axes_to_judge = !options.channels.empty() && !options.beside;
  if (const Result<void> sound = check_options(paths, options); !sound) {
    return tl::make_unexpected(sound.error());
  }
  std::atomic<double> done = 0.0;
  std::vector<Result<Judged>> tables(paths.size());
  for_each_index(paths.size(), [&](std::size_t i) {
    FileProgress own(progress, done, paths.size());
    tables[i] = read_table_safely(paths[i], options, own);
  });
  for (std::size_t i = 0; i < paths.size(); ++i) {
    if (!tables[i]) return tl::make_unexpected(tables[i].error());
    const std::string file = paths[i].string();
    const Result<void> long_enough = check_parts(file, *tables[i], options.split_into);
    if (!long_enough) return tl::make_unexpected(long_enough.error());
    const Result<void> same =
        check_agreement(paths.front().string(), *tables.front(), file, *tables[i]);
    if (!same) return tl::make_unexpected(same.error());
  }
  // Every file's channels in the first file's order.
  for (std::size_t i = 1; i < paths.size(); ++i) {
    const std::vector<Column>& order = tables.front()->columns;
    for (std::size_t c = 0; c < order.size(); ++c) {
      auto& columns = tables[i]->columns;
      const auto found = std::find_if(columns.begin(), columns.end(), [&](const Column& column) {
        return column.name == order[c].name;
      });
      std::swap(tables[i]->units[c],
                tables[i]->units[static_cast<std::size_t>(found - columns.begin())]);
      std::swap(columns[c], *found);
    }
  }
  const std::vector<std::string> names = replicate_names(paths);
  const Hertz rate = tables.front()->rate;
  std::vector<Replicate> out;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    add_replicates(paths[i], names[i], rate, std::move(*tables[i]), options.split_into, out);
  }
  return out;
}

}  // namespace imunoise::recording
