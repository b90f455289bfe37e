// What the USB-SPI bridges are told.

#include <gtest/gtest.h>

#include "drivers/adis16405/bridges/cp2130.h"
#include "drivers/adis16405/bridges/mpsse.h"
#include "drivers/adis16405/codec/burst.h"
#include "tests/drivers/wire.h"
#include "tests/support/golden.h"

namespace imunoise::drivers::adis16405 {
namespace {

using drivers::testing::from_hex;
using imunoise::testing::read_json;

using ByteVector = std::vector<std::uint8_t>;

ByteVector mpsse_bursts(std::size_t count, bool on_data_ready) {
  ByteVector out;
  for (std::size_t i = 0; i < count; ++i) {
    append_mpsse_transfer(out, kBurstRequest, on_data_ready);
    append_mpsse_flush(out);
  }
  return out;
}

TEST(Mpsse, VectorsAgree) {
  IMUNOISE_NEEDS("vectors/wire.json");
  const auto vector = read_json("vectors/wire.json")["ft232h_mpsse"];
  const ByteVector burst = from_hex(vector["burst_mode3_hex"].get<std::string>());
  EXPECT_EQ(mpsse_bursts(1, false), burst);
  ByteVector triggered = from_hex(vector["drdy_triggered_prefix_hex"].get<std::string>());
  triggered.insert(triggered.end(), burst.begin(), burst.end());
  EXPECT_EQ(mpsse_bursts(1, true), triggered);
  // "8a 97 8d", "85", "86 1d 00 (...)", "80 09 0b (...)": the lines behind the synchronisation
  ByteVector setup;
  for (std::size_t i = 2; i < 6; ++i) {
    const std::string line = vector["init"][i];
    const ByteVector bytes = from_hex(line.substr(0, line.find(" (")));
    setup.insert(setup.end(), bytes.begin(), bytes.end());
  }
  EXPECT_EQ(mpsse_setup(Hertz{1e6}), setup);
  EXPECT_EQ(vector["init"][0].get<std::string>().substr(0, 2), "aa");
}

// An engine that does what the opcodes say, as seen from the sensor.
struct Pins {
  bool clock = true;
  bool select = true;
  std::string seen;  // events in order

  void run(const ByteVector& commands) {
    for (std::size_t i = 0; i < commands.size();) {
      switch (commands[i]) {
        case 0x80: {
          const bool now_clock = (commands[i + 1] & 1U) != 0;
          const bool now_select = (commands[i + 1] & 8U) != 0;
          if (now_select != select) seen += now_select ? "] " : "[ ";
          if (now_clock != clock && !now_select && !select) seen += now_clock ? "up " : "down ";
          clock = now_clock;
          select = now_select;
          i += 3;
          break;
        }
        case 0x31: {
          const std::size_t length = commands[i + 1] + commands[i + 2] * 256U + 1;
          seen += std::to_string(length) + (clock || select ? "wrong " : "bytes ");
          i += 3 + length;
          break;
        }
        case 0x8f:
          seen += std::to_string(8 * (commands[i + 1] + commands[i + 2] * 256U + 1)) + "cycles ";
          i += 3;
          break;
        case 0x88:
        case 0x89:
          seen += commands[i] == 0x88 ? "wait-high " : "wait-low ";
          ++i;
          break;
        case 0x87:
          seen += "send ";
          ++i;
          break;
        default:
          seen += "unknown ";
          return;
      }
    }
  }
};

TEST(Mpsse, QueuedBurstsAreSelectedClockedAndSentOneByOne) {
  Pins pins;
  pins.run(mpsse_bursts(2, true));
  const std::string one = "wait-low wait-high [ down 26bytes ] send ";
  EXPECT_EQ(pins.seen, one + one);
  EXPECT_TRUE(pins.clock);
  EXPECT_TRUE(pins.select);
  Pins longer;
  ByteVector commands;
  append_mpsse_transfer(commands, ByteVector(300, 0x88), false);
  longer.run(commands);
  EXPECT_EQ(longer.seen, "[ down 300bytes ] ");
}

TEST(Mpsse, MarksAreIdleLines) {
  ByteVector commands;
  append_mpsse_mark(commands);
  EXPECT_EQ(commands, from_hex("81"));
  // Clock and chip select high, data out low; the other pins may be anything.
  for (unsigned byte = 0; byte < 256; ++byte) {
    EXPECT_EQ(is_mpsse_mark(static_cast<std::uint8_t>(byte)),
              (byte & 0x01U) != 0 && (byte & 0x02U) == 0 && (byte & 0x08U) != 0);
  }
}

TEST(Mpsse, PausesAreNeverShorterThanAsked) {
  using namespace std::chrono_literals;
  for (const auto& [pause, cycles] : {std::pair{150us, "152cycles "}, std::pair{1us, "8cycles "}}) {
    Pins pins;
    ByteVector commands;
    append_mpsse_pause(commands, pause, Hertz{1e6});
    pins.run(commands);
    EXPECT_EQ(pins.seen, cycles);
    EXPECT_TRUE(pins.clock && pins.select);
  }
}

TEST(Mpsse, ClockIsNeverFasterThanAsked) {
  for (const double wanted : {0.3e6, 0.999e6, 1e6, 2e6, 30e6}) {
    const ByteVector setup = mpsse_setup(Hertz{wanted});
    const double divisor = setup[5] + 256.0 * setup[6];
    const double clock = 60e6 / (2.0 * (1.0 + divisor));
    EXPECT_LE(clock, wanted);
    EXPECT_GT(60e6 / (2.0 * divisor), wanted);  // one less would be too fast (or is no divisor)
  }
}

TEST(Ftdi, StatusBytesAreTakenOffEveryPacket) {
  ByteVector sent;
  ByteVector transfer;
  for (std::size_t i = 0; i < 1200; ++i) {
    if (transfer.size() % 512 == 0) transfer.insert(transfer.end(), {0x32, 0x60});
    sent.push_back(static_cast<std::uint8_t>(i * 7));
    transfer.push_back(sent.back());
  }
  ByteVector got;
  strip_ftdi_status(transfer, got);
  EXPECT_EQ(got, sent);
  strip_ftdi_status(from_hex("3260"), got);  // a packet without data
  strip_ftdi_status({}, got);
  EXPECT_EQ(got, sent);
}

TEST(Cp2130, RequestsAreAsDocumented) {
  EXPECT_EQ(cp2130_spi_word(0, Hertz{1e6}), (Cp2130Request{0x31, {0x00, 0x3c}}));  // 750 kHz
  EXPECT_EQ(cp2130_spi_word(3, Hertz{12e6}), (Cp2130Request{0x31, {0x03, 0x38}}));
  EXPECT_EQ(cp2130_spi_word(0, Hertz{0.1e6}), (Cp2130Request{0x31, {0x00, 0x3f}}));
  EXPECT_EQ(cp2130_select_only(1), (Cp2130Request{0x25, {1, 2}}));
  EXPECT_EQ(cp2130_no_delays(1).data.size(), 8U);
  const ByteVector burst = cp2130_write_read(kBurstRequest);
  EXPECT_EQ(burst.size(), 34U);
  EXPECT_EQ(ByteVector(burst.begin(), burst.begin() + 10), from_hex("00000200 1a000000 3e00"));
}

}  // namespace
}  // namespace imunoise::drivers::adis16405
