#include "drivers/can/codec/utf8.h"

#include "core/support/utf8.h"

namespace imunoise::drivers {

std::string utf8_text(std::string_view text) {
  if (is_utf8(text)) return std::string(text);
  std::string out;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x80) {
      out += c;
    } else {
      out += static_cast<char>(0xc0U | code >> 6U);
      out += static_cast<char>(0x80U | (code & 0x3fU));
    }
  }
  return out;
}

}  // namespace imunoise::drivers
