#include "recording/store/manifest/manifest.h"

#include <fmt/core.h>

#include <algorithm>

#include "recording/store/format/crc32c.h"
#include "recording/store/format/format_version.h"
#include "recording/store/format/layout.h"

namespace imunoise::recording {
namespace {

constexpr const char* kNotClosed =
    "it was not closed: the program, the machine, its power or its disk failed while it was "
    "recorded";
constexpr std::uint64_t kLargestManifest = std::uint64_t{256} << 20U;  // bytes

void add_replicate(v1::Manifest& whole, const v1::ReplicateManifest& replicate) {
  if (replicate.has_note()) *whole.add_replicates() = replicate.note();
  whole.mutable_chunks()->MergeFrom(replicate.chunks());
  for (const v1::DamagedFile& one : replicate.damaged()) set_damaged(*whole.mutable_damaged(), one);
}

v1::Manifest without_replicates(const v1::RecordingManifest& recording) {
  v1::Manifest out;
  out.set_version(recording.version());
  out.set_campaign(recording.campaign());
  out.set_started_ns(recording.started_ns());
  out.set_closed(recording.closed());
  *out.mutable_devices() = recording.devices();
  *out.mutable_metadata() = recording.metadata();
  *out.mutable_damaged() = recording.damaged();
  return out;
}

// Puts on record what is promised and has no manifest.
void tell_missing(const v1::RecordingManifest& recording, WholeManifest& to) {
  for (const v1::ReplicateRange& range : recording.settled()) {
    for (std::uint64_t i = range.first(); i <= range.last(); ++i) {
      const auto replicate = static_cast<std::uint32_t>(i);
      if (to.replicates.contains(replicate)) continue;
      to.missing.insert(replicate);
      to.defects.push_back(replicate_manifest(replicate) +
                           ": is missing; put it back, or imunoise verify --repair makes it again "
                           "from the chunks");
    }
  }
}

// Replicates that have a manifest, among the names in a recording's folder.
std::set<std::uint32_t> with_manifest(const std::vector<std::string>& names) {
  std::set<std::uint32_t> out;
  for (const std::string& name : names) {
    if (const auto replicate = replicate_of_manifest(name)) out.insert(*replicate);
  }
  return out;
}

// Adds what the manifests of replicates say.
Result<void> add_replicates(const FileSystem& files, const std::filesystem::path& root,
                            WholeManifest& to) {
  for (const std::uint32_t replicate : to.replicates) {
    const std::filesystem::path file = root / replicate_manifest(replicate);
    const auto text = read_manifest_text(files, file);
    if (!text) return tl::make_unexpected(text.error());
    const auto part = parse_replicate_manifest(file.string(), *text, replicate);
    if (part) {
      add_replicate(to.manifest, *part);
    } else {
      to.defects.push_back(part.error().message);
    }
  }
  return {};
}

}  // namespace

Result<std::string> read_manifest_text(const FileSystem& files, const std::filesystem::path& file) {
  return files.read(file, kLargestManifest);
}

Result<void> write_recording_manifest(FileSystem& files, const std::filesystem::path& root,
                                      v1::RecordingManifest& manifest) {
  manifest.set_version(kManifestVersion);
  return replace_file(files, root / kManifestName, print_manifest(manifest));
}

Result<void> write_replicate_manifest(FileSystem& files, const std::filesystem::path& root,
                                      std::uint32_t replicate, v1::ReplicateManifest& manifest) {
  manifest.set_version(kManifestVersion);
  return replace_file(files, root / replicate_manifest(replicate), print_manifest(manifest));
}

Result<std::optional<WholeManifest>> read_whole_manifest(const FileSystem& files,
                                                         const std::filesystem::path& root) {
  const auto names = files.list(root);
  if (!names) return tl::make_unexpected(names.error());
  if (std::find(names->begin(), names->end(), kManifestName) == names->end())
    return std::optional<WholeManifest>();
  const std::filesystem::path file = root / kManifestName;
  const auto text = read_manifest_text(files, file);
  if (!text) return tl::make_unexpected(text.error());
  const auto found = parse_recording_manifest(file.string(), *text);
  if (!found) return tl::make_unexpected(found.error());
  WholeManifest out{without_replicates(found->recording), with_manifest(*names), {}, {}};
  if (found->replicates) {
    out.replicates.clear();
    for (const auto& [replicate, part] : *found->replicates) {
      add_replicate(out.manifest, part);
      out.replicates.insert(replicate);
    }
    return std::optional(std::move(out));
  }
  tell_missing(found->recording, out);
  if (auto done = add_replicates(files, root, out); !done) return tl::make_unexpected(done.error());
  return std::optional(std::move(out));
}

Result<std::optional<v1::Manifest>> read_manifest(const FileSystem& files,
                                                  const std::filesystem::path& root) {
  auto whole = read_whole_manifest(files, root);
  if (!whole) return tl::make_unexpected(whole.error());
  if (!*whole) return std::optional<v1::Manifest>();
  if (!(*whole)->defects.empty())
    return fail(fmt::format("{}: {}", root.string(), (*whole)->defects.front()));
  return std::optional(std::move((*whole)->manifest));
}

std::string manifest_stamp(const FileSystem& files, const std::filesystem::path& root) {
  std::string all;
  const auto names = files.list(root);
  if (!names) return crc32c_text(all);
  for (const std::string& name : *names) {
    if (name == kManifestName || replicate_of_manifest(name))
      all += read_manifest_text(files, root / name).value_or("");
  }
  return crc32c_text(all);
}

v1::Manifest whole_manifest(const v1::RecordingManifest& recording,
                            const v1::ReplicateManifest& replicate) {
  v1::Manifest out = without_replicates(recording);
  add_replicate(out, replicate);
  return out;
}

Result<void> check_same(const v1::RecordingManifest& manifest, const v1::RecordedDevice& device) {
  // These have the name of a file, port or interface for a number.
  if (device.driver() == "text" || device.driver() == "can") return {};
  for (const v1::RecordedDevice& listed : manifest.devices()) {
    const bool known = !listed.serial().empty() && !device.serial().empty();
    if (listed.name() != device.name() || !known || listed.serial() == device.serial()) continue;
    return fail(fmt::format(
        "{}: found serial number {}, expected {}, which this recording has; record into another "
        "folder",
        device.name(), device.serial(), listed.serial()));
  }
  return {};
}

void add_device(v1::RecordingManifest& manifest, const v1::RecordedDevice& device) {
  const auto& devices = manifest.devices();
  if (std::none_of(devices.begin(), devices.end(), [&](const v1::RecordedDevice& other) {
        return other.name() == device.name();
      })) {
    *manifest.add_devices() = device;
  }
}

void end_open_replicate(v1::ReplicateNote& note, const std::string& reason) {
  if (note.state() != v1::open) return;
  note.set_state(v1::interrupted);
  note.set_reason(reason.empty() ? kNotClosed : "it was not closed: " + reason);
}

void sort_chunks(v1::ReplicateManifest& manifest) {
  std::sort(manifest.mutable_chunks()->begin(), manifest.mutable_chunks()->end(),
            [](const auto& a, const auto& b) { return a.file() < b.file(); });
}

void set_damaged(google::protobuf::RepeatedPtrField<v1::DamagedFile>& all,
                 const v1::DamagedFile& damaged) {
  const auto place = [](const v1::DamagedFile& one) {
    return std::pair(std::string_view(one.file()), std::string_view(one.kept_as()));
  };
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
