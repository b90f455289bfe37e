#include "drivers/xsens/codec/frame.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/drivers/wire.h"

namespace imunoise::drivers {
namespace {

using testing::from_hex;

using Payload = std::vector<std::uint8_t>;

struct Found {
  std::vector<Payload> payloads;
  Refusals refused;
};

Found parse(Bytes bytes, std::size_t piece = ~std::size_t{0}) {
  XbusParser parser;
  Found out;
  const auto drain = [&] {
    while (const auto frame = parser.next()) {
      out.payloads.emplace_back(frame->payload.begin(), frame->payload.end());
    }
  };
  while (!bytes.empty()) {
    const Bytes now = bytes.first(std::min(piece, bytes.size()));
    bytes = bytes.subspan(now.size());
    parser.push(now);
    drain();
  }
  parser.finish();
  drain();
  out.refused = parser.refused();
  return out;
}

Payload random_payload(std::mt19937_64& random, std::size_t length) {
  Payload out(length);
  for (std::uint8_t& byte : out) byte = static_cast<std::uint8_t>(random());
  return out;
}

TEST(XbusFrame, HasTheDocumentedBytes) {
  EXPECT_EQ(encode_xbus_frame(0x31, {}), from_hex("faff3100d0"));
  EXPECT_EQ(encode_xbus_frame(0x64, from_hex("0002")), from_hex("faff6402000299"));
}

TEST(XbusFrame, ReturnsAtEveryLength) {
  constexpr std::uint64_t kSeed = 1;
  SCOPED_TRACE(kSeed);
  std::mt19937_64 random(kSeed);
  for (const std::size_t length : {0U, 1U, 253U, 254U, 255U, 256U, 2047U, 2048U}) {
    const Payload payload = random_payload(random, length);
    const auto bytes = encode_xbus_frame(0x36, payload);
    EXPECT_EQ(bytes.size(), length + (length < 255 ? 5 : 7));
    const Found found = parse(bytes);
    ASSERT_EQ(found.payloads.size(), 1U) << length;
    EXPECT_EQ(found.payloads.front(), payload);
    EXPECT_TRUE(found.refused.none());
  }
}

TEST(XbusFrame, RefusesABadChecksum) {
  const Found found = parse(from_hex("faff3100d1"));
  EXPECT_TRUE(found.payloads.empty());
  EXPECT_EQ(found.refused.count(Refusal::kChecksum), 1U);
  EXPECT_EQ(found.refused.count(Refusal::kOutsideMessages), 4U);
}

TEST(XbusFrame, RefusesAnImpossibleLength) {
  const Found found = parse(from_hex("faff36ff0801 faff3100d0"));
  ASSERT_EQ(found.payloads.size(), 1U);
  EXPECT_EQ(found.refused.count(Refusal::kLength), 1U);
}

TEST(XbusFrame, FindsAFrameBehindAFalsePreamble) {
  EXPECT_EQ(parse(from_hex("fafffaff3100d0")).payloads.size(), 1U);
  // The false frame claims more bytes than come: what lies within it is found at the end.
  const Found found = parse(from_hex("faff36c0 faff3100d0"));
  ASSERT_EQ(found.payloads.size(), 1U);
  EXPECT_EQ(found.refused.count(Refusal::kTruncated), 1U);
}

TEST(XbusFrame, WaitsForBytesThatAreStillToCome) {
  XbusParser parser;
  const auto bytes = from_hex("faff6402000299");
  for (std::size_t i = 0; i + 1 < bytes.size(); ++i) {
    parser.push(Bytes(bytes).subspan(i, 1));
    EXPECT_FALSE(parser.next());
  }
  parser.push(Bytes(bytes).last(1));
  EXPECT_TRUE(parser.next());
  EXPECT_TRUE(parser.refused().none());
}

// Frames with noise between them, handed over in pieces of any size: every true frame is found, and
// what is found does not depend on the pieces.
TEST(XbusFrame, FindsEveryFrameAmongNoise) {
  constexpr std::uint64_t kSeed = 2;
  SCOPED_TRACE(kSeed);
  std::mt19937_64 random(kSeed);
  for (int round = 0; round < 50; ++round) {
    std::vector<std::uint8_t> bytes;
    std::vector<Payload> sent;
    for (int i = 0; i < 20; ++i) {
      const Payload noise = random_payload(random, random() % 40);
      // A preamble in the noise could swallow the frame behind it only if a checksum fits by
      // chance; without one the truth is known.
      std::copy_if(noise.begin(), noise.end(), std::back_inserter(bytes),
                   [](std::uint8_t byte) { return byte != 0xfa; });
      sent.push_back(random_payload(random, random() % 300));
      const auto frame = encode_xbus_frame(0x36, sent.back());
      bytes.insert(bytes.end(), frame.begin(), frame.end());
    }
    const Found whole = parse(bytes);
    EXPECT_EQ(whole.payloads, sent);
    for (const std::size_t piece : {1U, 7U, 512U}) {
      const Found pieces = parse(bytes, piece);
      EXPECT_EQ(pieces.payloads, whole.payloads) << piece;
      EXPECT_EQ(pieces.refused, whole.refused) << piece;
    }
  }
}

// One changed byte costs one frame: the frames around it are all found.
TEST(XbusFrame, LosesOneFrameToAChangedByte) {
  constexpr std::uint64_t kSeed = 3;
  SCOPED_TRACE(kSeed);
  std::mt19937_64 random(kSeed);
  for (int round = 0; round < 500; ++round) {
    std::vector<std::uint8_t> bytes;
    std::vector<Payload> sent;
    for (int i = 0; i < 5; ++i) {
      sent.push_back(random_payload(random, 50));
      const auto frame = encode_xbus_frame(0x36, sent.back());
      bytes.insert(bytes.end(), frame.begin(), frame.end());
    }
    const std::size_t hit = 2 * 55 + random() % 55;
    bytes[hit] = static_cast<std::uint8_t>(bytes[hit] ^ (1U + random() % 255));
    const Found found = parse(bytes);
    for (const std::size_t i : {0U, 1U, 3U, 4U}) {
      EXPECT_NE(std::find(found.payloads.begin(), found.payloads.end(), sent[i]),
                found.payloads.end())
          << "round " << round << " frame " << i;
    }
    EXPECT_EQ(std::find(found.payloads.begin(), found.payloads.end(), sent[2]),
              found.payloads.end());
    EXPECT_FALSE(found.refused.none());
  }
}

}  // namespace
}  // namespace imunoise::drivers
