#include "recording/store/manifest.h"

#include <fmt/core.h>
#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <cassert>

#include "recording/store/crc32c.h"
#include "recording/store/format_version.h"
#include "recording/store/layout.h"

namespace imunoise::recording {
namespace {

constexpr const char* kNotClosed =
    "it was not closed: the program, the machine, its power or its disk failed while it was "
    "recorded";
constexpr std::uint64_t kLargestManifest = std::uint64_t{256} << 20U;  // bytes; a million chunks

// A path that a manifest may name: replicate-N/DEVICE/NNNNNN.h5.
bool is_chunk_path(const std::string& file) {
  const std::size_t first = file.find('/');
  const std::size_t last = file.rfind('/');
  return first != std::string::npos && last > first && replicate_of(file.substr(0, first)) &&
         file.find('/', first + 1) == last && file[first + 1] != '.' &&
         number_of(file.substr(last + 1), kChunkSuffix);
}

}  // namespace

Result<v1::Manifest> parse_manifest(std::string_view file, std::string_view json) {
  const auto trouble = [&](const std::string& what) {
    return fail(
        fmt::format("{}: {}; imunoise verify --repair makes it again from the chunks", file, what));
  };
  v1::Manifest out;
  google::protobuf::util::JsonParseOptions strict;
  strict.ignore_unknown_fields = false;
  const auto status = google::protobuf::util::JsonStringToMessage(
      google::protobuf::StringPiece(json.data(), json.size()), &out, strict);
  if (!status.ok()) return trouble(status.message().ToString());
  if (out.version() != kFormatVersion)
    return fail(fmt::format("{}: {}", file, other_version(out.version())));
  for (const v1::RecordedDevice& device : out.devices()) {
    if (auto good = check_device(device); !good) {
      return trouble(fmt::format("device {}: {}", device.name(), good.error().message));
    }
  }
  for (const v1::ChunkEntry& chunk : out.chunks()) {
    if (!is_chunk_path(chunk.file())) {
      return trouble(fmt::format("'{}' is no chunk of this folder", chunk.file()));
    }
  }
  return out;
}

std::string print_manifest(const v1::Manifest& manifest) {
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

Result<std::optional<std::string>> read_manifest_text(const FileSystem& files,
                                                      const std::filesystem::path& root) {
  const auto there = contains(files, root, kManifestName);
  if (!there) return tl::make_unexpected(there.error());
  if (!*there) return std::optional<std::string>();
  auto text = files.read(root / kManifestName, kLargestManifest);
  if (!text) return tl::make_unexpected(text.error());
  return std::optional(std::move(*text));
}

Result<std::optional<v1::Manifest>> read_manifest(const FileSystem& files,
                                                  const std::filesystem::path& root) {
  const auto text = read_manifest_text(files, root);
  if (!text) return tl::make_unexpected(text.error());
  if (!*text) return std::optional<v1::Manifest>();
  Result<v1::Manifest> manifest = parse_manifest((root / kManifestName).string(), **text);
  if (!manifest) return tl::make_unexpected(manifest.error());
  return std::optional(std::move(*manifest));
}

bool of_other_version(const std::string& json) {
  v1::Manifest out;
  google::protobuf::util::JsonParseOptions lenient;  // later versions have fields of their own
  lenient.ignore_unknown_fields = true;
  const auto status = google::protobuf::util::JsonStringToMessage(json, &out, lenient);
  return status.ok() && out.version() != 0 && out.version() != kFormatVersion;
}

Result<void> write_manifest(FileSystem& files, const std::filesystem::path& root,
                            const v1::Manifest& manifest) {
  return replace_file(files, root / kManifestName, print_manifest(manifest));
}

void add_device(v1::Manifest& manifest, const v1::RecordedDevice& device) {
  const auto& devices = manifest.devices();
  if (std::none_of(devices.begin(), devices.end(), [&](const v1::RecordedDevice& other) {
        return other.name() == device.name();
      })) {
    *manifest.add_devices() = device;
  }
}

void set_note(v1::Manifest& manifest, const v1::ReplicateNote& note) {
  auto& notes = *manifest.mutable_replicates();
  const auto same = std::find_if(notes.begin(), notes.end(), [&](const v1::ReplicateNote& one) {
    return one.replicate() == note.replicate();
  });
  if (same != notes.end()) {
    *same = note;
    return;
  }
  *notes.Add() = note;
  std::sort(notes.begin(), notes.end(), [](const v1::ReplicateNote& a, const v1::ReplicateNote& b) {
    return a.replicate() < b.replicate();
  });
}

void end_open_replicates(v1::Manifest& manifest, const std::string& reason) {
  for (v1::ReplicateNote& note : *manifest.mutable_replicates()) {
    if (note.state() != v1::open) continue;
    note.set_state(v1::interrupted);
    note.set_reason(reason.empty() ? kNotClosed : "it was not closed: " + reason);
  }
}

void sort_chunks(v1::Manifest& manifest) {
  const auto place = [](const v1::ChunkEntry& chunk) {
    const std::string& file = chunk.file();
    return std::pair(replicate_of(file.substr(0, file.find('/'))), std::string_view(file));
  };
  std::sort(manifest.mutable_chunks()->begin(), manifest.mutable_chunks()->end(),
            [&](const auto& a, const auto& b) { return place(a) < place(b); });
}

void set_damaged(v1::Manifest& manifest, const v1::DamagedFile& damaged) {
  const auto place = [](const v1::DamagedFile& one) {
    return std::pair(std::string_view(one.file()), std::string_view(one.kept_as()));
  };
  auto& all = *manifest.mutable_damaged();
  const auto same = std::find_if(all.begin(), all.end(), [&](const v1::DamagedFile& one) {
    return place(one) == place(damaged);
  });
  if (same != all.end()) {
    *same = damaged;
    return;
  }
  *all.Add() = damaged;
  std::sort(all.begin(), all.end(),
            [&](const auto& a, const auto& b) { return place(a) < place(b); });
}

std::set<std::string> promised_folders(const v1::Manifest& manifest) {
  std::set<std::string> out;
  for (const v1::ChunkEntry& chunk : manifest.chunks())
    out.insert(chunk.file().substr(0, chunk.file().rfind('/')));
  for (const v1::ReplicateNote& note : manifest.replicates()) {
    for (const v1::StreamCount& count : note.streams()) {
      if (count.stored() > count.missing())
        out.insert(replicate_folder(note.replicate()) + "/" + count.device());
    }
  }
  return out;
}

Checksums checksums(const v1::Manifest& manifest) {
  Checksums out;
  for (const v1::ChunkEntry& chunk : manifest.chunks()) out[chunk.file()] = chunk.crc32c();
  return out;
}

std::string fingerprint(const v1::Manifest& manifest) {
  std::string all;
  for (const auto& [file, checksum] : checksums(manifest)) all += file + ' ' + checksum + '\n';
  return crc32c_text(all);
}

}  // namespace imunoise::recording
