#include "recording/store/manifest/manifest_text.h"

#include <fmt/core.h>
#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <cassert>

#include "recording/store/format/crc32c.h"
#include "recording/store/format/format_version.h"
#include "recording/store/format/layout.h"
#include "recording/store/manifest/manifest.h"
#include "recording/store/manifest/replicate_set.h"

namespace imunoise::recording {
namespace {

constexpr std::uint64_t kMostReplicates = 1'000'000;  // of a recording

// The replicate of a path that a manifest may name: replicate-N/DEVICE/NNNNNN.h5.
std::optional<std::uint32_t> replicate_of_chunk(const std::string& file) {
  const std::size_t first = file.find('/');
  const std::size_t last = file.rfind('/');
  if (first == std::string::npos || last <= first || file.find('/', first + 1) != last ||
      file[first + 1] == '.' || !number_of(file.substr(last + 1), kChunkSuffix))
    return std::nullopt;
  return replicate_of(file.substr(0, first));
}

// Whose manifest has a file's record; nothing: that of the recording.
std::optional<std::uint32_t> replicate_of_file(const std::string& file) {
  const auto inside = replicate_of(file.substr(0, file.find('/')));
  return inside ? inside : replicate_of_manifest(file);
}

google::protobuf::StringPiece piece(std::string_view text) { return {text.data(), text.size()}; }

// Every manifest has its version; one of a newer version may have anything besides.
std::uint32_t version_of(std::string_view json) {
  v1::RecordingManifest out;
  google::protobuf::util::JsonParseOptions lenient;
  lenient.ignore_unknown_fields = true;
  const auto status = google::protobuf::util::JsonStringToMessage(piece(json), &out, lenient);
  return status.ok() ? out.version() : 0;
}

bool is_read(std::uint32_t version) { return version >= 1 && version <= kManifestVersion; }

Error damaged_manifest(std::string_view file, std::string_view what) {
  return {
      fmt::format("{}: {}; imunoise verify --repair makes it again from the chunks", file, what)};
}

// Error: as parse_recording_manifest()'s, without what depends on the kind of manifest.
Result<void> parse_json(std::string_view file, std::string_view json,
                        google::protobuf::Message& to) {
  google::protobuf::util::JsonParseOptions strict;
  strict.ignore_unknown_fields = false;
  const auto status = google::protobuf::util::JsonStringToMessage(piece(json), &to, strict);
  if (status.ok()) return {};
  return tl::make_unexpected(damaged_manifest(file, status.message().ToString()));
}

Result<void> check_version(std::string_view file, std::uint32_t version) {
  if (version == 0) return tl::make_unexpected(damaged_manifest(file, "is no manifest"));
  if (is_read(version)) return {};
  return fail(fmt::format("{}: {}", file, other_version(version, kManifestVersion)));
}

Result<void> check_devices(std::string_view file,
                           const google::protobuf::RepeatedPtrField<v1::RecordedDevice>& devices) {
  for (const v1::RecordedDevice& device : devices) {
    if (auto good = check_device(device); !good) {
      return tl::make_unexpected(damaged_manifest(
          file, fmt::format("device {}: {}", device.name(), good.error().message)));
    }
  }
  return {};
}

// `replicate` 0: of any.
Result<void> check_chunks(std::string_view file,
                          const google::protobuf::RepeatedPtrField<v1::ChunkEntry>& chunks,
                          std::uint32_t replicate) {
  for (const v1::ChunkEntry& chunk : chunks) {
    const auto of = replicate_of_chunk(chunk.file());
    if (!of || (replicate != 0 && *of != replicate)) {
      return tl::make_unexpected(
          damaged_manifest(file, fmt::format("'{}' is not a chunk of this folder", chunk.file())));
    }
  }
  return {};
}

Result<RecordingManifestFile> parse_version_1(std::string_view file, std::string_view json) {
  v1::Manifest whole;
  if (auto done = parse_json(file, json, whole); !done) return tl::make_unexpected(done.error());
  if (auto good = check_devices(file, whole.devices()); !good)
    return tl::make_unexpected(good.error());
  if (auto good = check_chunks(file, whole.chunks(), 0); !good)
    return tl::make_unexpected(good.error());
  return split_manifest(whole);
}

}  // namespace

Result<RecordingManifestFile> parse_recording_manifest(std::string_view file,
                                                       std::string_view json) {
  const std::uint32_t version = version_of(json);
  if (version == 1) return parse_version_1(file, json);
  RecordingManifestFile out;
  if (version > 1) {
    if (auto good = check_version(file, version); !good) return tl::make_unexpected(good.error());
  }
  if (auto done = parse_json(file, json, out.recording); !done)
    return tl::make_unexpected(done.error());
  if (auto good = check_version(file, version); !good) return tl::make_unexpected(good.error());
  if (auto good = check_devices(file, out.recording.devices()); !good)
    return tl::make_unexpected(good.error());
  if (!is_replicate_set(out.recording.settled(), kMostReplicates))
    return tl::make_unexpected(damaged_manifest(file, "its settled replicates are no ranges"));
  return out;
}

Result<v1::ReplicateManifest> parse_replicate_manifest(std::string_view file, std::string_view json,
                                                       std::uint32_t replicate) {
  v1::ReplicateManifest out;
  const std::uint32_t version = version_of(json);
  if (version != 0) {
    if (auto good = check_version(file, version); !good) return tl::make_unexpected(good.error());
  }
  if (auto done = parse_json(file, json, out); !done) return tl::make_unexpected(done.error());
  if (auto good = check_version(file, version); !good) return tl::make_unexpected(good.error());
  if (auto good = check_chunks(file, out.chunks(), replicate); !good)
    return tl::make_unexpected(good.error());
  if (out.has_note() && out.note().replicate() != replicate)
    return tl::make_unexpected(damaged_manifest(
        file, fmt::format("is of replicate {}, not {}", out.note().replicate(), replicate)));
  return out;
}

std::string print_manifest(const google::protobuf::Message& manifest) {
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = true;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  std::string out;
  const auto status = google::protobuf::util::MessageToJsonString(manifest, &out, options);
  assert(status.ok());
  (void)status;
  return out;
}

bool of_other_version(std::string_view json) {
  const std::uint32_t version = version_of(json);
  return version != 0 && !is_read(version);
}

RecordingManifestFile split_manifest(const v1::Manifest& whole) {
  RecordingManifestFile out;
  v1::RecordingManifest& recording = out.recording;
  recording.set_version(whole.version());
  recording.set_campaign(whole.campaign());
  recording.set_started_ns(whole.started_ns());
  recording.set_closed(whole.closed());
  *recording.mutable_devices() = whole.devices();
  *recording.mutable_metadata() = whole.metadata();
  std::map<std::uint32_t, v1::ReplicateManifest>& replicates = out.replicates.emplace();
  for (const v1::ReplicateNote& note : whole.replicates()) {
    *replicates[note.replicate()].mutable_note() = note;
    if (note.settled() && note.state() != v1::open)
      insert(*recording.mutable_settled(), note.replicate());
  }
  for (const v1::ChunkEntry& chunk : whole.chunks())
    *replicates[replicate_of_chunk(chunk.file()).value_or(0)].add_chunks() = chunk;
  for (const v1::DamagedFile& one : whole.damaged()) {
    const auto replicate = replicate_of_file(one.file());
    set_damaged(
        replicate ? *replicates[*replicate].mutable_damaged() : *recording.mutable_damaged(), one);
  }
  return out;
}

}  // namespace imunoise::recording
