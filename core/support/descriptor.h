#pragma once

#include <unistd.h>

#include <utility>

namespace imunoise {

/// Closes the open file that it holds; a negative one is none.
class Descriptor {
 public:
  explicit Descriptor(int value = -1) : value_(value) {}
  Descriptor(Descriptor&& other) noexcept : value_(std::exchange(other.value_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(value_, other.value_);
    return *this;
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }

  int get() const { return value_; }
  /// Hands it over: the new owner closes it.
  int release() { return std::exchange(value_, -1); }

 private:
  int value_;
};

}  // namespace imunoise
