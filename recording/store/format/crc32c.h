#pragma once

// CRC-32C (Castagnoli), the checksum of journal frames and chunk files.

#include <cstdint>
#include <string>
#include <string_view>

namespace imunoise::recording {

/// CRC-32C of the concatenation of two strings (RFC 3720, appendix B.4: of "123456789" it is
/// e3069283).
std::uint32_t crc32c(std::string_view bytes, std::string_view more = {});

/// As the manifest writes it: 8 hexadecimal digits.
std::string crc32c_text(std::string_view bytes);

/// The same without the processor's own instruction.
std::uint32_t crc32c_by_table(std::string_view bytes, std::string_view more = {});

}  // namespace imunoise::recording
