#include "core/support/utf8.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace imunoise {
namespace {

// Every code point in its own encoding, and no other: the encoder is written from the definition.
TEST(Utf8, HasOneFormOfEveryCodePoint) {
  const auto encoded = [](std::uint32_t code, int bytes) {
    std::string out;
    for (int i = 0; i < bytes; ++i) {
      out.insert(out.begin(), static_cast<char>(0x80U | (code & 0x3FU)));
      code >>= 6U;
    }
    constexpr std::uint32_t kLead[] = {0, 0, 0xC0, 0xE0, 0xF0};
    out[0] = static_cast<char>(kLead[bytes] | (static_cast<unsigned char>(out[0]) & 0x3FU) | code);
    return out;
  };
  std::size_t good = 0;
  for (std::uint32_t code = 0x80; code < 0x120000; code += code < 0x11000 ? 1 : 7) {
    const int shortest = code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
    const bool exists = code < 0x110000 && (code < 0xD800 || code > 0xDFFF);
    for (int bytes = shortest; bytes <= 4; ++bytes) {
      const std::string text = encoded(code, bytes);
      ASSERT_EQ(is_utf8(text), exists && bytes == shortest) << code << " in " << bytes;
      good += is_utf8(text) ? 1U : 0U;
      for (std::size_t cut = 1; cut < text.size(); ++cut)
        ASSERT_FALSE(is_utf8(text.substr(0, cut)));
    }
  }
  EXPECT_GT(good, 100'000U);
}

TEST(Utf8, LonelyBytesAreNone) {
  EXPECT_TRUE(is_utf8(""));
  EXPECT_TRUE(is_utf8(std::string_view("a\0b", 3)));
  for (int byte = 0x80; byte < 0x100; ++byte) {
    const std::string text = {'a', static_cast<char>(byte), 'b'};
    EXPECT_FALSE(is_utf8(text)) << byte;
    EXPECT_EQ(repaired_utf8(text),
              "a\xEF\xBF\xBD"
              "b")
        << byte;
  }
}

TEST(Utf8, RepairsEachByteThatDoesNotFit) {
  EXPECT_EQ(repaired_utf8("°/√h 😀"), "°/√h 😀");
  EXPECT_EQ(repaired_utf8("\xb0/s"), "\xEF\xBF\xBD/s");
  EXPECT_EQ(repaired_utf8("cut \xE2\x88"), "cut \xEF\xBF\xBD\xEF\xBF\xBD");
  EXPECT_TRUE(is_utf8(repaired_utf8("\xFF\xFE\xC0\x80\xED\xA0\x80")));
}

}  // namespace
}  // namespace imunoise
