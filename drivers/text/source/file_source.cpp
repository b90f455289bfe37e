#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include "drivers/plugin/device.h"
#include "drivers/text/source/descriptor.h"
#include "drivers/text/source/source.h"

namespace imunoise::text {
namespace {

class FileSource final : public Source {
 public:
  explicit FileSource(const std::string& path) : path_(path) {
    struct stat about {};
    // Opened for writing as well, a pipe does not end when its writer does.
    const bool pipe = ::stat(path.c_str(), &about) == 0 && S_ISFIFO(about.st_mode);
    constexpr int kHow = O_NONBLOCK | O_NOCTTY | O_CLOEXEC;
    file_ = Descriptor(::open(path.c_str(), (pipe ? O_RDWR : O_RDONLY) | kHow));
    if (file_.number() >= 0) return;
    const std::error_code error(errno, std::generic_category());
    throw plugin::DeviceError(
        error == std::errc::permission_denied ? IMUNOISE_NO_ACCESS : IMUNOISE_NOT_FOUND,
        fmt::format("{}: {}", path, error.message()));
  }
  int descriptor() const override { return file_.number(); }
  std::optional<std::size_t> read(std::span<std::uint8_t> into) override {
    try {
      return file_.read(into);
    } catch (const std::system_error& error) {
      throw plugin::DeviceError(IMUNOISE_DISCONNECTED,
                                fmt::format("{}: {}", path_, error.code().message()));
    }
  }

 private:
  std::string path_;
  Descriptor file_;
};

}  // namespace

SourcePlace file_source(const std::string& path) {
  struct stat about {};
  const bool whole = ::stat(path.c_str(), &about) == 0 && S_ISREG(about.st_mode);
  return {path, !whole, [path](const plugin::Wait&) { return std::make_unique<FileSource>(path); }};
}

}  // namespace imunoise::text
