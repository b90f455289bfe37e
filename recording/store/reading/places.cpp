#include "recording/store/reading/places.h"

#include <fmt/core.h>

#include <utility>

#include "recording/store/format/layout.h"

namespace imunoise::recording {

// With device and stream in front where names alone may be ambiguous.
std::vector<ImportedStream> imported_streams(const v1::Manifest& manifest) {
  std::vector<ImportedStream> out;
  const bool single = manifest.devices_size() == 1 && manifest.devices(0).streams_size() == 1;
  for (const v1::RecordedDevice& device : manifest.devices()) {
    for (const v1::RecordedStream& stream : device.streams()) {
      out.push_back({device.name(), stream.name(), {}});
      for (const v1::RecordedChannel& channel : stream.channels()) {
        out.back().channels.push_back(
            {single ? channel.name()
                    : fmt::format("{}/{}/{}", device.name(), stream.name(), channel.name()),
             channel.units()});
      }
    }
  }
  return out;
}

Offers offers_of(const v1::Manifest& manifest) {
  Offers out;
  const std::vector<ImportedStream> streams = imported_streams(manifest);
  int number = 0;  // of the stream in its device
  for (std::size_t s = 0; s < streams.size(); ++s) {
    number = s > 0 && streams[s - 1].device == streams[s].device ? number + 1 : 0;
    for (std::size_t c = 0; c < streams[s].channels.size(); ++c) {
      out.names.push_back({streams[s].channels[c].name, true, streams[s].channels[c].units});
      out.places.push_back({streams[s].device, number, static_cast<int>(c)});
    }
  }
  return out;
}

Result<std::vector<Wanted>> wanted_of(const std::string& file, const Offers& offers,
                                      const std::vector<std::string>& channels) {
  ImportOptions options;
  options.channels = channels;
  const auto chosen = select_columns(file, offers.names, options);
  if (!chosen) return tl::make_unexpected(chosen.error());
  std::vector<Wanted> out;
  for (const std::size_t i : *chosen) out.push_back({offers.names[i].name, offers.places[i]});
  return out;
}

Result<v1::Manifest> manifest_of(const FileSystem& files, const std::filesystem::path& root) {
  auto manifest = read_manifest(files, root);
  if (!manifest) return tl::make_unexpected(manifest.error());
  if (*manifest) return std::move(**manifest);
  return fail(
      fmt::format("{}: is a folder without a {}: name the files in it, or make the manifest "
                  "with imunoise verify --repair",
                  root.string(), kManifestName));
}

Samples samples_of(Numbers numbers) {
  return std::visit(
      [](auto& values) -> Samples {
        using Values = std::decay_t<decltype(values)>;
        if constexpr (std::is_constructible_v<Samples, Values&&>) {
          return Samples(std::move(values));
        } else {
          return std::vector<double>(values.begin(), values.end());
        }
      },
      numbers);
}

Channel in_si(const std::string& name, const v1::RecordedChannel& channel, const Unit& unit,
              Hertz rate) {
  Channel out;
  out.name = name;
  out.scale = (channel.has_scale_factor() ? channel.scale_factor() : 1.0) * unit.to_si;
  out.offset = channel.add_offset() * unit.to_si + unit.si_offset;
  out.unit = unit;
  out.rate = rate;
  return out;
}

}  // namespace imunoise::recording
