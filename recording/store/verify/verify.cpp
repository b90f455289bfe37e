#include "recording/store/verify/verify.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "recording/store/format/layout.h"
#include "recording/store/reading/device_recording.h"
#include "recording/store/recovery/recover.h"
#include "recording/store/verify/integrity.h"
#include "recording/store/verify/promises.h"

namespace imunoise::recording {
namespace {

using Path = std::filesystem::path;

void add_defect(v1::VerifyReport& report, const std::string& message, bool repaired) {
  v1::Defect* const defect = report.add_defects();
  defect->set_message(message);
  defect->set_repaired(repaired);
}

void add_streams(v1::VerifyReport& report, std::uint32_t replicate,
                 const v1::RecordedDevice& device, const std::vector<Rows>& streams,
                 const std::vector<std::uint64_t>& in_journal) {
  for (std::size_t i = 0; i < streams.size(); ++i) {
    v1::StreamIntegrity* const out = report.add_streams();
    *out = check_stream(device.streams(static_cast<int>(i)), streams[i]);
    out->set_replicate(replicate);
    out->set_device(device.name());
    if (!in_journal.empty()) out->set_in_journal(in_journal[i]);
  }
}

void finish(v1::VerifyReport& report) {
  const auto& defects = report.defects();
  report.set_sound(std::all_of(defects.begin(), defects.end(),
                               [](const v1::Defect& one) { return one.repaired(); }));
}

// Replicates that have samples and no manifest.
void check_manifests(const WholeManifest& whole, const std::vector<DeviceFolder>& folders,
                     v1::VerifyReport& report) {
  if (whole.manifest.version() == 1) return;  // it had none
  std::set<std::uint32_t> told = whole.missing;
  for (const DeviceFolder& where : folders) {
    const std::uint32_t replicate = where.replicate();
    if (whole.replicates.contains(replicate)) continue;
    if (!told.insert(replicate).second) continue;
    add_defect(report,
               replicate_manifest(replicate) +
                   ": is missing; imunoise verify --repair makes it from the chunks",
               false);
  }
}

// The manifest, or what of it there is, and a defect for the rest.
v1::Manifest manifest_or_defect(const FileSystem& files, const Path& root,
                                const std::vector<DeviceFolder>& folders,
                                v1::VerifyReport& report) {
  auto manifest = read_whole_manifest(files, root);
  const std::string name = (root / kManifestName).string();
  if (!manifest) {
    add_defect(report, manifest.error().message, false);
    return {};
  }
  if (!*manifest) {
    add_defect(report, name + ": is missing; imunoise verify --repair makes it from the chunks",
               false);
    return {};
  }
  WholeManifest& whole = **manifest;
  for (const std::string& defect : whole.defects) add_defect(report, defect, false);
  check_manifests(whole, folders, report);
  if (!whole.manifest.closed()) {
    add_defect(report,
               name +
                   ": the recording was not closed: it is still running, or was interrupted "
                   "(imunoise verify --repair closes it)",
               false);
  }
  return std::move(whole.manifest);
}

// Manifests that were set aside.
Result<std::vector<std::string>> broken_manifests(const FileSystem& files, const Path& root) {
  const auto names = files.list(root);
  if (!names) return tl::make_unexpected(names.error());
  std::vector<std::string> out;
  for (const std::string& name : *names) {
    if (!is_broken(name)) continue;
    const std::string_view before = name_before(name);
    if (before == kManifestName || replicate_of_manifest(before)) out.push_back(name);
  }
  return out;
}

}  // namespace

Result<v1::VerifyReport> verify_recording(FileSystem& files, const Path& folder, bool repair) {
  v1::VerifyReport report;
  report.set_folder(folder.string());
  const auto folders = find_device_folders(files, folder);
  if (!folders) return tl::make_unexpected(folders.error());
  const auto listed = contains(files, folder, kManifestName);
  if (!listed) return tl::make_unexpected(listed.error());
  if (!*listed && folders->empty()) {
    return fail(
        fmt::format("{}: is not a recording: it has neither a {} nor a folder {}; name the "
                    "folder that has",
                    folder.string(), kManifestName, replicate_folder(1)));
  }
  if (repair) {
    const auto lock = files.lock(folder);
    if (!lock) return tl::make_unexpected(lock.error());
    const auto recovered = recover_recording(files, folder, Recovery::kEverything);
    if (!recovered) return tl::make_unexpected(recovered.error());
    for (const std::string& what : recovered->repaired) add_defect(report, what, true);
  }
  const v1::Manifest manifest = manifest_or_defect(files, folder, *folders, report);
  std::uint32_t chunks = 0;
  auto broken = broken_manifests(files, folder);
  if (!broken) return tl::make_unexpected(broken.error());
  for (const DeviceFolder& where : *folders) {
    const auto device = read_device(files, where, manifest);
    if (!device) return tl::make_unexpected(device.error());
    for (const std::string& defect : device->defects) add_defect(report, defect, false);
    chunks += static_cast<std::uint32_t>(device->chunks);
    add_streams(report, where.replicate(), device->device, device->streams, device->in_journal);
    broken->insert(broken->end(), device->broken.begin(), device->broken.end());
  }
  for (const v1::Defect& one : broken_promises(manifest, report, *folders, *broken)) {
    if (!repair || !one.repaired()) *report.add_defects() = one;  // a repair has told it already
  }
  report.set_chunks(chunks);
  finish(report);
  return report;
}

Result<v1::VerifyReport> verify_chunk(const FileSystem& files, const Path& file) {
  if (file.extension() != kChunkSuffix)
    return fail(fmt::format(
        "{} is not a recording of imunoise (a folder, or a chunk {} of one); imunoise wv reads "
        "other files",
        file.string(), kChunkSuffix));
  v1::VerifyReport report;
  report.set_folder(file.string());
  const auto bytes = files.read(file);
  if (!bytes) return tl::make_unexpected(bytes.error());
  const auto chunk = decode_chunk(*bytes);
  if (!chunk) {
    add_defect(report,
               fmt::format("chunk {}: {}; verify the folder of the recording to see what of it is "
                           "intact",
                           file.string(), chunk.error().message),
               false);
  } else {
    report.set_chunks(1);
    add_streams(report, chunk->replicate, chunk->device, chunk->streams, {});
  }
  finish(report);
  return report;
}

}  // namespace imunoise::recording
