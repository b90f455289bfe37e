#include "recording/store/verify/promises.h"

#include <fmt/core.h>

#include <algorithm>

#include "recording/store/format/layout.h"

namespace imunoise::recording {
namespace {

v1::Defect defect(std::string message, bool repaired) {
  v1::Defect out;
  out.set_message(std::move(message));
  out.set_repaired(repaired);
  return out;
}

constexpr std::string_view kWayOut =
    "; put a copy back, or imunoise verify --repair puts the loss on record";

void check_damaged(const v1::Manifest& manifest, const std::vector<std::string>& broken,
                   std::vector<v1::Defect>& out) {
  for (const v1::DamagedFile& one : manifest.damaged()) {
    const std::string what =
        one.kept_as().empty()
            ? one.reason()
            : fmt::format("{}: was set aside as {}: {}", one.file(), one.kept_as(), one.reason());
    out.push_back(defect(what + (one.accepted() ? "" : std::string(kWayOut)), one.accepted()));
  }
  for (const std::string& file : broken) {
    const bool known =
        std::any_of(manifest.damaged().begin(), manifest.damaged().end(),
                    [&](const v1::DamagedFile& one) { return one.kept_as() == file; });
    if (!known) {
      out.push_back(defect(
          file + ": was damaged and set aside; imunoise verify --repair puts it on record", false));
    }
  }
}

std::uint64_t rows_found(const v1::VerifyReport& report, std::uint32_t replicate,
                         const v1::StreamCount& count) {
  std::uint64_t out = 0;
  for (const v1::StreamIntegrity& one : report.streams()) {
    if (one.replicate() == replicate && one.device() == count.device() &&
        one.stream() == count.stream())
      out += one.stored() + one.in_journal();
  }
  return out;
}

void check_rows(const v1::Manifest& manifest, const v1::VerifyReport& report,
                std::vector<v1::Defect>& out) {
  for (const v1::ReplicateNote& note : manifest.replicates()) {
    for (const v1::StreamCount& count : note.streams()) {
      const std::uint64_t found = rows_found(report, note.replicate(), count);
      if (found >= count.stored()) continue;
      const std::uint64_t missing = count.stored() - found;
      const bool accepted = missing <= count.missing();
      out.push_back(defect(
          fmt::format("replicate {}, device {}, stream {}: {} of {} stored samples are missing{}",
                      note.replicate(), count.device(), count.stream(), missing, count.stored(),
                      accepted ? "" : kWayOut),
          accepted));
    }
  }
}

void check_folders(const v1::Manifest& manifest, const std::vector<DeviceFolder>& there,
                   std::vector<v1::Defect>& out) {
  for (const v1::ChunkEntry& chunk : manifest.chunks()) {
    const std::string folder = chunk.file().substr(0, chunk.file().rfind('/'));
    const bool found = std::any_of(there.begin(), there.end(),
                                   [&](const DeviceFolder& one) { return one.folder == folder; });
    if (!found) out.push_back(defect(chunk.file() + ": is missing" + std::string(kWayOut), false));
  }
}

}  // namespace

std::vector<v1::Defect> broken_promises(const v1::Manifest& manifest,
                                        const v1::VerifyReport& report,
                                        const std::vector<DeviceFolder>& there,
                                        const std::vector<std::string>& broken) {
  std::vector<v1::Defect> out;
  check_damaged(manifest, broken, out);
  check_folders(manifest, there, out);
  check_rows(manifest, report, out);
  return out;
}

}  // namespace imunoise::recording
