#include "daemon/catalogue/scan.h"

#include <algorithm>

#include "recording/store/format/crc32c.h"
#include "recording/store/format/layout.h"
#include "recording/store/manifest/manifest.h"
#include "study/calibration/calibration_file.h"

namespace imunoise::catalogue {
namespace {

constexpr int kDeepest = 12;  // folders below the root

// A manifest, or replicates whose manifest was lost.
bool is_recording(const std::vector<std::string>& names) {
  return std::any_of(names.begin(), names.end(), [](const std::string& name) {
    return name == recording::kManifestName ||
           (name.ends_with('/') && recording::replicate_of(name.substr(0, name.size() - 1)));
  });
}

void seek(const recording::FileSystem& files, const std::filesystem::path& root,
          const std::string& below, const std::vector<std::string>& names, int depth,
          std::vector<std::string>& out) {
  if (is_recording(names)) {
    out.push_back(below.empty() ? "." : below);
    return;
  }
  for (const std::string& name : names) {
    if (!name.ends_with('/') || name.starts_with('.') || depth == kDeepest) continue;
    const std::string folder = name.substr(0, name.size() - 1);
    const std::string path = below.empty() ? folder : below + "/" + folder;
    std::error_code unknown;
    if (std::filesystem::is_symlink(root / path, unknown)) continue;
    const auto inside = files.list(root / path);
    if (inside) seek(files, root, path, *inside, depth + 1, out);  // others have their secrets
  }
}

// Empty where the file cannot be read, which is told when it is understood.
std::string contents(const recording::FileSystem& files, const std::filesystem::path& path) {
  std::error_code unknown;
  if (!std::filesystem::exists(path, unknown)) return "";
  return files.read(path).value_or("");
}

}  // namespace

Result<std::vector<std::string>> find_recordings(const recording::FileSystem& files,
                                                 const std::filesystem::path& root) {
  const auto names = files.list(root);
  if (!names) return tl::unexpected(names.error());
  std::vector<std::string> out;
  seek(files, root, "", *names, 0, out);
  std::sort(out.begin(), out.end());
  return out;
}

std::string stamp_of(const recording::FileSystem& files, const std::filesystem::path& recording) {
  return recording::manifest_stamp(files, recording) + " " +
         recording::crc32c_text(contents(files, recording / study::kCalibrationName));
}

Found read_found(const recording::FileSystem& files, const std::filesystem::path& root,
                 const std::string& folder) {
  const std::filesystem::path path = root / folder;
  Found out;
  out.folder = folder;
  out.stamp = stamp_of(files, path);
  auto manifest = recording::read_manifest(files, path);
  if (!manifest) {
    out.trouble = manifest.error().message;
  } else if (!*manifest) {
    out.trouble = path.string() + ": no manifest.json; imunoise verify --repair makes it again";
  } else {
    out.manifest = std::move(**manifest);
  }
  auto calibration = study::read_calibration(files, path);
  if (calibration) {
    out.calibration = std::move(*calibration);
  } else {
    out.calibration_trouble = calibration.error().message;
  }
  return out;
}

std::string device_id(const v1::RecordedDevice& device) {
  return device.serial().empty() ? device.name() : device.driver() + ":" + device.serial();
}

}  // namespace imunoise::catalogue
