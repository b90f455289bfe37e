#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace imunoise::study {

/// SHA-256 of bytes that come piece by piece (FIPS 180-4), as sha256sum prints it.
class Sha256 {
 public:
  /// `portable`: without the processor's own instructions, which make no other difference.
  explicit Sha256(bool portable = false) : portable_(portable) {}
  void add(std::string_view bytes);
  /// 64 hexadecimal digits. The object cannot be used any more.
  std::string hex();

 private:
  void compress(const unsigned char* blocks, std::size_t count);

  std::array<std::uint32_t, 8> state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                         0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<unsigned char, 64> block_{};
  std::uint64_t length_ = 0;  // bytes
  bool portable_;
};

/// Of a whole text.
std::string sha256(std::string_view bytes);

}  // namespace imunoise::study
