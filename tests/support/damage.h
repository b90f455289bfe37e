#pragma once

// Bytes as a bad disk gives them back.

#include <cstddef>
#include <random>
#include <string>

namespace imunoise {

/// Damages the byte at `at`: one of its bits, all of it, or whatever `worse` does. `random`
/// decides; the same on every machine.
template <class Worse>
void damage(std::string& bytes, std::size_t at, std::mt19937& random, const Worse& worse) {
  switch (random() % 3) {
    case 0:
      bytes[at] = static_cast<char>(static_cast<unsigned char>(bytes[at]) ^ (1U << random() % 8));
      break;
    case 1:
      bytes[at] = static_cast<char>(random() % 256);
      break;
    default:
      worse();
  }
}

}  // namespace imunoise
