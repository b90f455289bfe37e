#include "drivers/can/codec/candump.h"

#include <fmt/core.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "drivers/can/codec/dbc.h"
#include "drivers/can/codec/dbc_file.h"
#include "drivers/can/codec/decoder.h"
#include "drivers/can/codec/presets.h"
#include "recording/import/table/format.h"
#include "recording/import/wire/decoded_streams.h"

// Logs of a CAN bus, as `candump -L` writes them. What the messages mean is the user's to say.

namespace imunoise::recording {
namespace {

bool begins_candump(std::string_view head) {
  const std::size_t end = head.find('\n');
  std::string_view line = head.substr(0, end);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return end != std::string_view::npos && drivers::parse_candump_line(line).has_value();
}

Result<drivers::CanChannels> channels_of(const std::string& dbc) {
  const auto presets = drivers::preset_names();
  if (std::find(presets.begin(), presets.end(), dbc) != presets.end())
    return drivers::make_preset(dbc);
  const auto text = drivers::read_dbc_text(dbc);
  if (!text) return tl::make_unexpected(text.error());
  Result<drivers::CanDatabase> database = drivers::parse_dbc(*text, dbc);
  if (!database) return tl::make_unexpected(database.error());
  return drivers::CanChannels::make(std::move(*database), {});
}

Result<Table> read_candump(const std::filesystem::path& path, const ImportOptions& options,
                           FileProgress& progress) {
  const Result<File> file = File::open(path);
  if (!file) return tl::make_unexpected(file.error());
  if (options.dbc.empty()) {
    std::string presets;
    for (const std::string_view one : drivers::preset_names())
      presets += fmt::format("{}{}", presets.empty() ? "" : ", ", one);
    return fail(
        fmt::format("{}: is a log of a CAN bus; say what its messages mean with --dbc FILE, "
                    "or with one of the known IMUs ({})",
                    file->name(), presets));
  }
  Result<drivers::CanChannels> channels = channels_of(options.dbc);
  if (!channels) return tl::make_unexpected(channels.error());
  drivers::CandumpDecoder decoder(std::move(*channels));
  return read_decoded(*file, decoder, options, progress);
}

Result<bool> claims_candump(const UnknownFile&) { return false; }

}  // namespace

namespace formats {

const ImportFormat& candump() {
  static constexpr ImportFormat kFormat = {.kind = "a log of candump -L (.log)",
                                           .begins = begins_candump,
                                           .claims = claims_candump,
                                           .read = read_candump};
  return kFormat;
}

}  // namespace formats

}  // namespace imunoise::recording
