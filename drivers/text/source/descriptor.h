#pragma once

#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <optional>
#include <span>
#include <system_error>
#include <utility>

namespace imunoise::text {

/// An open file descriptor that does not block.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  int number() const { return number_; }

  /// What has come; 0: nothing now; empty: the other end closed. Throws std::system_error.
  std::optional<std::size_t> read(std::span<std::uint8_t> into) const {
    for (;;) {
      const ssize_t got = ::read(number_, into.data(), into.size());
      if (got > 0) return static_cast<std::size_t>(got);
      if (got == 0) return std::nullopt;
      if (errno == EAGAIN) return 0;
      if (errno != EINTR) throw std::system_error(errno, std::generic_category());
    }
  }

 private:
  int number_;
};

}  // namespace imunoise::text
