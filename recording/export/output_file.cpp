#include "recording/export/output_file.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace imunoise::recording {
namespace {

tl::unexpected<Error> cannot_write(const std::filesystem::path& target, std::string_view reason) {
  return fail(
      fmt::format("{}: cannot be written: {}; check the folder, its permissions and the space "
                  "left",
                  target.string(), reason));
}

std::filesystem::path beside(const std::filesystem::path& target) {
  std::filesystem::path out = target;
  out += fmt::format(".part{}", ::getpid());
  return out;
}

}  // namespace

TemporaryName::TemporaryName(const std::filesystem::path& target)
    : target_(target), temporary_(beside(target)) {}

TemporaryName::~TemporaryName() {
  std::error_code ignored;
  if (!committed_) std::filesystem::remove(temporary_, ignored);
}

Result<void> TemporaryName::commit() {
  std::error_code error;
  std::filesystem::rename(temporary_, target_, error);
  if (error) return cannot_write(target_, error.message());
  committed_ = true;
  return {};
}

OutputFile::OutputFile(const std::filesystem::path& target) : target_(target), name_(target) {
  file_.reset(std::fopen(name_.path().c_str(), "wb"));
  if (!file_) error_ = errno;
}

void OutputFile::write(std::string_view bytes) {
  if (error_ == 0 && std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) {
    error_ = errno;
  }
}

Result<void> OutputFile::finish() {
  if (file_ && std::fclose(file_.release()) != 0 && error_ == 0) error_ = errno;
  if (error_ != 0) return cannot_write(target_, std::generic_category().message(error_));
  return name_.commit();
}

}  // namespace imunoise::recording
