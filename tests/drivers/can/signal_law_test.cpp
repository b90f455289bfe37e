// The packing of bits, against a reference that walks over them one by one.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "drivers/can/codec/signal.h"

namespace imunoise::drivers {
namespace {

constexpr std::size_t kBytes = 64;

// The bits of a field from the least significant on, as (byte, bit).
std::vector<std::pair<std::size_t, std::size_t>> places(const BitField& field) {
  std::vector<std::pair<std::size_t, std::size_t>> out;
  if (field.order == ByteOrder::kLittle) {
    for (std::size_t i = 0; i < field.length; ++i) {
      out.emplace_back((field.start + i) / 8, (field.start + i) % 8);
    }
    return out;
  }
  // From the most significant bit down through the byte, then to the top of the next byte.
  std::size_t at = field.start;
  for (std::size_t i = 0; i < field.length; ++i) {
    out.insert(out.begin(), {at / 8, at % 8});
    at = at % 8 == 0 ? at + 15 : at - 1;
  }
  return out;
}

BitField random_field(std::mt19937_64& random) {
  while (true) {
    const BitField field{random() % (8 * kBytes), 1 + random() % 64,
                         random() % 2 == 0 ? ByteOrder::kLittle : ByteOrder::kBig};
    if (bytes_needed(field) <= kBytes) return field;
  }
}

TEST(CanBits, AgreeWithAWalkOverSingleBits) {
  constexpr std::uint64_t kSeed = 7;
  SCOPED_TRACE(kSeed);
  std::mt19937_64 random(kSeed);
  for (int round = 0; round < 10'000; ++round) {
    const BitField field = random_field(random);
    std::array<std::uint8_t, kBytes> data{};
    for (std::uint8_t& byte : data) byte = static_cast<std::uint8_t>(random());
    std::uint64_t wanted = 0;
    std::size_t last = 0;
    const auto where = places(field);
    for (std::size_t i = 0; i < where.size(); ++i) {
      const auto [byte, bit] = where[i];
      wanted |= (std::uint64_t{data[byte]} >> bit & 1U) << i;
      last = std::max(last, byte);
    }
    ASSERT_EQ(extract_bits(data, field), wanted)
        << field.start << "|" << field.length << "@" << static_cast<int>(field.order);
    ASSERT_EQ(bytes_needed(field), last + 1);

    const std::uint64_t written = random();
    auto reference = data;
    for (std::size_t i = 0; i < where.size(); ++i) {
      const auto [byte, bit] = where[i];
      const unsigned one = 1U << bit;
      reference[byte] = static_cast<std::uint8_t>(
          (written >> i & 1U) != 0 ? reference[byte] | one : reference[byte] & ~one);
    }
    insert_bits(data, field, written);
    ASSERT_EQ(data, reference);  // nothing beside the field has changed
  }
}

TEST(CanSignal, PhysicalValuesReturn) {
  constexpr std::uint64_t kSeed = 8;
  SCOPED_TRACE(kSeed);
  std::mt19937_64 random(kSeed);
  for (int round = 0; round < 10'000; ++round) {
    CanSignal signal;
    signal.field = random_field(random);
    signal.field.length = 1 + random() % 50;  // whole numbers that a double holds
    signal.type = random() % 2 == 0 ? SignalType::kSigned : SignalType::kUnsigned;
    signal.factor = std::ldexp(1.0, static_cast<int>(random() % 20) - 10);
    signal.offset = signal.factor * (static_cast<double>(random() % 2001) - 1000.0);
    const std::uint64_t mask = (std::uint64_t{1} << signal.field.length) - 1;
    const std::uint64_t bits = random() & mask;
    const double physical = physical_value(signal, bits);
    const auto again = bits_for(signal, physical);
    ASSERT_TRUE(again) << again.error().message;
    ASSERT_EQ(*again, bits);
  }
}

TEST(CanSignal, SignsFloatsAndLimits) {
  CanSignal signal;
  signal.name = "S";
  signal.field.length = 4;
  EXPECT_EQ(physical_value(signal, 0xf), 15.0);
  EXPECT_FALSE(bits_for(signal, 16.0));
  EXPECT_FALSE(bits_for(signal, -1.0));
  EXPECT_FALSE(bits_for(signal, std::nan("")));
  signal.type = SignalType::kSigned;
  EXPECT_EQ(physical_value(signal, 0xf), -1.0);
  EXPECT_EQ(physical_value(signal, 0x8), -8.0);
  EXPECT_EQ(*bits_for(signal, -8.0), 0x8U);
  EXPECT_FALSE(bits_for(signal, 8.0));
  signal.field.length = 64;
  EXPECT_EQ(physical_value(signal, ~std::uint64_t{0}), -1.0);
  signal.field.length = 32;
  signal.type = SignalType::kFloat32;
  EXPECT_EQ(physical_value(signal, 0x3f800000), 1.0);
  EXPECT_EQ(*bits_for(signal, -2.0), 0xc0000000U);
  signal.field.length = 64;
  signal.type = SignalType::kFloat64;
  EXPECT_EQ(physical_value(signal, *bits_for(signal, 0.1)), 0.1);
}

}  // namespace
}  // namespace imunoise::drivers
