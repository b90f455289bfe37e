#include <string_view>

#include "drivers/xsens/codec/decoder.h"
#include "drivers/xsens/codec/frame.h"
#include "recording/import/table/format.h"
#include "recording/import/wire/decoded_streams.h"

// Bytes of an Xsens device, as they came over its line (MTi captures).

namespace imunoise::recording {
namespace {

// A false frame has one chance in 256; the first bytes of a capture hold dozens of true ones.
bool begins_xbus(std::string_view head) {
  constexpr std::size_t least = 3;
  drivers::XbusParser parser;
  parser.push(drivers::Bytes(reinterpret_cast<const std::uint8_t*>(head.data()), head.size()));
  std::size_t frames = 0;
  std::size_t bytes = 0;
  while (const auto frame = parser.next()) {
    ++frames;
    bytes += frame->payload.size() + 5;
  }
  return frames >= least && 2 * bytes > head.size();
}

Result<Table> read_xbus(const std::filesystem::path& path, const ImportOptions& options,
                        FileProgress& progress) {
  const Result<File> file = File::open(path);
  if (!file) return tl::make_unexpected(file.error());
  drivers::XbusDecoder decoder;
  return read_decoded(*file, decoder, options, progress);
}

Result<bool> claims_xbus(const UnknownFile&) { return false; }

}  // namespace

namespace formats {

const ImportFormat& xbus() {
  static constexpr ImportFormat kFormat = {.kind = "a capture of an Xsens device",
                                           .begins = begins_xbus,
                                           .claims = claims_xbus,
                                           .read = read_xbus};
  return kFormat;
}

}  // namespace formats

}  // namespace imunoise::recording
