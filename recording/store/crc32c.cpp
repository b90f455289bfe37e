#include "recording/store/crc32c.h"

#include <fmt/core.h>

#include <boost/crc.hpp>

namespace imunoise::recording {

std::uint32_t crc32c(std::string_view bytes, std::string_view more) {
  boost::crc_optimal<32, 0x1EDC6F41, 0xFFFFFFFF, 0xFFFFFFFF, true, true> crc;
  crc.process_bytes(bytes.data(), bytes.size());
  crc.process_bytes(more.data(), more.size());
  return crc.checksum();
}

std::string crc32c_text(std::string_view bytes) { return fmt::format("{:08x}", crc32c(bytes)); }

}  // namespace imunoise::recording
