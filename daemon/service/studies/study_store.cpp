#include "daemon/service/studies/study_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "daemon/service/recordings/confined_files.h"
#include "study/ladder/study.h"
#include "study/ladder/study_file.h"

namespace imunoise::service {
namespace {

constexpr std::string_view kSuffix = ".study";
constexpr std::size_t kLongest = 64;

}  // namespace

Answer<void> check_study_name(const std::string& name) {
  const bool good =
      !name.empty() && name.size() <= kLongest && name.front() != '.' &&
      std::all_of(name.begin(), name.end(), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || c == '.';
      });
  if (good) return {};
  return refuse(
      400,
      "a study's name has 1 to 64 letters, digits, '_', '-' and '.', and does not begin with '.'");
}

StudyStore::StudyStore(std::filesystem::path folder, recording::DiskCalls& calls)
    : folder_(std::filesystem::absolute(folder).lexically_normal()),
      calls_(calls),
      confined_(confined_files({folder_})),
      files_(*confined_, calls),
      disk_(recording::posix_file_system(), calls) {}

std::filesystem::path StudyStore::file_of(const std::string& name) const {
  return folder_ / (name + std::string(kSuffix));
}

bool StudyStore::contains(const std::string& name) const {
  const recording::DiskCalls::Watch watch(calls_, "stat", file_of(name));
  std::error_code unknown;
  return std::filesystem::exists(std::filesystem::symlink_status(file_of(name), unknown));
}

Answer<v1::StudyList> StudyStore::list() const {
  v1::StudyList out;
  const auto there = disk_.exists(folder_);
  if (!there || !*there) return out;
  const auto names = files_.list(folder_);
  if (!names) return refuse(500, names.error().message);
  for (const std::string& file : *names) {
    if (!file.ends_with(kSuffix)) continue;
    v1::StudySummary& one = *out.add_studies();
    one.set_study(file.substr(0, file.size() - kSuffix.size()));
    const auto study = read(one.study());
    if (!study) {
      one.set_trouble(study.error().sentence);
      continue;
    }
    one.set_channel(study->channel());
    one.set_model(study::current_model(*study));
    one.set_attempts(static_cast<std::uint32_t>(study->attempts_size()));
  }
  return out;
}

Answer<void> StudyStore::check_known(const std::string& name) const {
  if (auto good = check_study_name(name); !good) return good;
  if (!contains(name)) return refuse(404, fmt::format("there is no study '{}'", name));
  return {};
}

Answer<v1::Study> StudyStore::read(const std::string& name) const {
  if (auto known = check_known(name); !known) return tl::unexpected(known.error());
  const auto text = files_.read(file_of(name));
  if (!text) return refuse(500, text.error().message);
  auto study = study::parse_study(*text);
  if (!study) return refuse(500, fmt::format("study '{}': {}", name, study.error().message));
  return std::move(*study);
}

Result<void> StudyStore::create(const std::string& name, const v1::Study& study) {
  const std::lock_guard lock(changing_);
  if (contains(name)) return fail("a study of this name exists");
  return write(name, study);
}

Result<void> StudyStore::replace(const std::string& name, const v1::Study& study) {
  const std::lock_guard lock(changing_);
  if (!contains(name)) return fail("the study was deleted while the command ran");
  return write(name, study);
}

Answer<void> StudyStore::remove(const std::string& name) {
  const std::lock_guard lock(changing_);
  if (auto known = check_known(name); !known) return known;
  auto done = disk_.remove(file_of(name));
  if (done) done = disk_.sync_folder(folder_);
  if (!done) return refuse(500, done.error().message);
  return {};
}

Result<void> StudyStore::write(const std::string& name, const v1::Study& study) const {
  if (auto made = recording::make_folders(disk_, folder_); !made) return made;
  return recording::replace_file(disk_, file_of(name), study::study_text(study));
}

}  // namespace imunoise::service
