#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <bit>
#include <vector>

#include "imunoise/v1/sidecar.pb.h"
#include "recording/export/formats.h"
#include "recording/export/output_file.h"

namespace imunoise::recording {
namespace {

static_assert(std::endian::native == std::endian::little, "doubles are written as they lie");

// Version 1.0: magic, version, length of the dictionary, the dictionary padded so that the numbers
// start at a multiple of 64 bytes.
std::string npy_start(std::size_t rows, std::size_t columns) {
  std::string dictionary =
      fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, {}), }}", rows, columns);
  constexpr std::size_t before = 10;
  dictionary.append(63 - (before + dictionary.size()) % 64, ' ');
  dictionary += '\n';
  std::string out("\x93NUMPY\x01\x00", 8);
  out += static_cast<char>(dictionary.size() % 256);
  out += static_cast<char>(dictionary.size() / 256);
  return out + dictionary;
}

Result<std::string> sidecar_json(std::span<const OutputChannel> channels, Hertz rate,
                                 const Metadata& metadata) {
  v1::Sidecar sidecar;
  sidecar.set_rate_hz(rate.value);
  sidecar.set_dtype("<f8");
  for (const OutputChannel& channel : channels) {
    v1::SidecarChannel& out = *sidecar.add_channels();
    out.set_name(channel.name);
    out.set_units(channel.unit.symbol);
  }
  for (const auto& [key, value] : metadata) (*sidecar.mutable_metadata())[key] = value;
  google::protobuf::util::JsonPrintOptions readable;
  readable.preserve_proto_field_names = true;
  readable.add_whitespace = true;
  std::string json;
  const auto status = google::protobuf::util::MessageToJsonString(sidecar, &json, readable);
  if (!status.ok()) return fail(status.ToString());
  return json;
}

}  // namespace

Result<void> write_npy(const std::filesystem::path& path, std::span<const OutputChannel> channels,
                       Hertz rate, const Metadata& metadata) {
  const Result<std::string> json = sidecar_json(channels, rate, metadata);
  if (!json) return fail(fmt::format("{}: {}", path.string(), json.error().message));
  const std::size_t rows = channels.front().values.size();
  OutputFile file(path);
  file.write(npy_start(rows, channels.size()));
  constexpr std::size_t block_rows = 4096;
  std::vector<double> block;
  for (std::size_t begin = 0; begin < rows; begin += block_rows) {
    block.clear();
    for (std::size_t i = begin; i < std::min(rows, begin + block_rows); ++i) {
      for (const OutputChannel& channel : channels) block.push_back(channel.values[i]);
    }
    file.write({static_cast<const char*>(static_cast<const void*>(block.data())),
                block.size() * sizeof(double)});
  }
  std::filesystem::path sidecar_path = path;
  sidecar_path += ".json";
  OutputFile sidecar(sidecar_path);
  sidecar.write(*json);
  if (const Result<void> written = sidecar.finish(); !written) return written;
  return file.finish();
}

}  // namespace imunoise::recording
