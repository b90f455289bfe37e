#pragma once

// The channels of a recording: how the user calls them, where they lie, what their numbers mean.

#include <string>
#include <vector>

#include "recording/import/table/channel.h"
#include "recording/import/table/select.h"
#include "recording/store/manifest/manifest.h"

namespace imunoise::recording {

struct ImportedChannel {
  std::string name;   ///< as import_recording() calls it
  std::string units;  ///< as the manifest writes them; may be empty
};

struct ImportedStream {
  std::string device;
  std::string stream;
  std::vector<ImportedChannel> channels;
};

/// What import_recording() can read: all streams of all devices, in the manifest's order.
std::vector<ImportedStream> imported_streams(const v1::Manifest& manifest);

struct Place {
  std::string device;
  int stream = 0;  ///< Index in RecordedDevice.streams.
  int channel = 0;
};

/// All channels, in the manifest's order: names[i] lies at places[i].
struct Offers {
  std::vector<Offer> names;
  std::vector<Place> places;
};
Offers offers_of(const v1::Manifest& manifest);

/// A channel that the user wants.
struct Wanted {
  std::string name;
  Place place;
};
/// In the order of `channels`, or all where that is empty. Error: a channel that is not offered.
/// `file` is for messages.
Result<std::vector<Wanted>> wanted_of(const std::string& file, const Offers& offers,
                                      const std::vector<std::string>& channels);

/// The manifest of a recording. Error: the disk's, or there is none.
Result<v1::Manifest> manifest_of(const FileSystem& files, const std::filesystem::path& root);

/// Counts stay counts; what core has no type for becomes a double.
Samples samples_of(Numbers numbers);

/// A channel without samples.
Channel in_si(const std::string& name, const v1::RecordedChannel& channel, const Unit& unit,
              Hertz rate);

}  // namespace imunoise::recording
