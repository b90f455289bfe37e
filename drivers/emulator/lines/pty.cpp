#include "drivers/emulator/lines/pty.h"

#include <asm/termbits.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <system_error>
#include <thread>
#include <utility>

namespace imunoise::emulator {
namespace {

constexpr std::chrono::seconds kDrainPatience{5};

int checked(int result, const char* what) {
  if (result < 0) throw std::system_error(errno, std::generic_category(), what);
  return result;
}

// A link to a terminal that is gone may be taken over.
void make_room(const std::filesystem::path& link) {
  std::error_code unknown;
  const auto there = std::filesystem::symlink_status(link, unknown);
  if (there.type() == std::filesystem::file_type::not_found) return;
  if (!std::filesystem::is_symlink(there))
    throw std::system_error(EEXIST, std::generic_category(),
                            link.string() + " is not a symbolic link");
  if (std::filesystem::exists(link, unknown))
    throw std::system_error(EADDRINUSE, std::generic_category(),
                            link.string() + " leads to a terminal; delete it if no emulator runs");
  std::filesystem::remove(link);
}

}  // namespace

Pty::Pty(std::filesystem::path link) : link_(std::move(link)) {
  make_room(link_);
  device_end_ = checked(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC), "posix_openpt");
  checked(::grantpt(device_end_), "grantpt");
  checked(::unlockpt(device_end_), "unlockpt");
  std::array<char, 64> name{};
  checked(::ptsname_r(device_end_, name.data(), name.size()), "ptsname_r");
  host_end_ = checked(::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC), "open");
  termios2 mode{};
  checked(::ioctl(host_end_, TCGETS2, &mode), "TCGETS2");
  mode.c_iflag = mode.c_oflag = mode.c_lflag = 0;  // bytes pass as they are
  checked(::ioctl(host_end_, TCSETS2, &mode), "TCSETS2");
  std::filesystem::create_symlink(name.data(), link_);
}

Pty::~Pty() {
  std::error_code ignored;
  std::filesystem::remove(link_, ignored);
  ::close(host_end_);
  ::close(device_end_);
}

std::size_t Pty::read(std::span<std::uint8_t> into, int timeout_ms) const {
  pollfd readable = {device_end_, POLLIN, 0};
  if (::poll(&readable, 1, timeout_ms) <= 0) return 0;
  const ssize_t count = ::read(device_end_, into.data(), into.size());
  return count < 0 ? 0 : static_cast<std::size_t>(count);
}

void Pty::write(drivers::Bytes bytes) const {
  [[maybe_unused]] const ssize_t count = ::write(device_end_, bytes.data(), bytes.size());
}

void Pty::drain() const {
  // A worker of the kernel hands bytes over, late on a busy machine. poll waits for it; FIONREAD
  // counts only what it has handed over.
  pollfd unread = {host_end_, POLLIN, 0};
  const auto deadline = std::chrono::steady_clock::now() + kDrainPatience;
  while (::poll(&unread, 1, 0) > 0 && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

std::uint32_t Pty::host_baud() const {
  termios2 mode{};
  checked(::ioctl(device_end_, TCGETS2, &mode), "TCGETS2");
  return mode.c_ospeed;
}

}  // namespace imunoise::emulator
