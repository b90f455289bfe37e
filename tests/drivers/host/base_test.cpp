// What a driver made with drivers/plugin.h gives the host: delivery, refusals, errors, waiting.

#include <gtest/gtest.h>

#include <condition_variable>
#include <cstddef>
#include <limits>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>

#include "drivers/host/services.h"
#include "tests/drivers/host/pretend_driver.h"

namespace imunoise {
namespace {

using namespace std::chrono_literals;
using drivers::NumberType;
using drivers::ReadOutcome;
using drivers::SampleBlock;
using plugin::Reason;
using plugin::Samples;
using plugin::Wait;

drivers::DeviceInfo two_streams() {
  return {{{.name = "imu",
            .channels = {{.name = "gyro", .type = NumberType::kInt16},
                         {.name = "acc", .type = NumberType::kFloat32},
                         {.name = "big", .type = NumberType::kInt64}},
            .nominal_rate_hz = 100.0,
            .counter_maximum = 255},
           {.name = "slow", .channels = {{.name = "temperature", .type = NumberType::kFloat64}}}},
          "pretend"};
}

// Does each step once, then nothing more comes.
testing::Pretend steps(std::vector<std::function<void(Samples&)>> all) {
  return {two_streams(), [all, next = std::size_t{0}](Samples& samples, const Wait&) mutable {
            if (next < all.size()) return all[next++](samples);
            samples.end();
          }};
}

// Names, units and serial numbers say what was recorded: those that are no text cannot be kept.
TEST(DriverBase, WhatIdentifiesADeviceIsUtf8) {
  const auto complaint = [](const std::function<void(drivers::DeviceInfo&)>& spoil) {
    testing::Pretend pretend = steps({});
    spoil(pretend.info);
    const auto device = testing::open(pretend);
    return device ? std::string("opened") : device.error().message;
  };
  const std::string latin1 = "\xb0/s";
  const std::string what = "'\xEF\xBF\xBD/s' is not UTF-8; the driver must convert it";
  EXPECT_NE(complaint([&](auto& info) { info.serial = latin1; }).find("serial: " + what),
            std::string::npos);
  EXPECT_NE(complaint([&](auto& info) { info.streams[0].name = latin1; }).find(what),
            std::string::npos);
  EXPECT_NE(complaint([&](auto& info) { info.streams[0].channels[1].name = latin1; }).find(what),
            std::string::npos);
  EXPECT_NE(complaint([&](auto& info) {
              info.streams[0].channels[1].units = latin1;
            }).find("stream 0: channel 1: units: " + what),
            std::string::npos);
  EXPECT_EQ(complaint([](auto& info) { info.streams[0].channels[1].units = "°/s"; }), "opened");
}

TEST(DriverBase, WhatDescribesADeviceIsRepaired) {
  testing::Pretend pretend = steps({});
  pretend.info.product = "Caf\xe9";
  pretend.info.firmware = "v\xff";
  pretend.info.streams[0].channels[0].long_name = "\xb0 a second";
  pretend.opening = [](const plugin::Host& host) { host.note("20 \xb0 C"); };
  std::string noted;
  const auto device =
      testing::open(pretend, [&](std::string_view text) { noted = std::string(text); });
  ASSERT_TRUE(device) << device.error().message;
  EXPECT_EQ((*device)->info().product, "Caf\xEF\xBF\xBD");
  EXPECT_EQ((*device)->info().firmware, "v\xEF\xBF\xBD");
  EXPECT_EQ((*device)->info().streams[0].channels[0].long_name, "\xEF\xBF\xBD a second");
  EXPECT_EQ(noted, "20 \xEF\xBF\xBD C");
}

TEST(DriverBase, DeliversSamplesAsTheyWereAdded) {
  const auto device = testing::open(steps({[](Samples& samples) {
    for (int i = 0; i < 3; ++i) {
      samples.add(0, {1000 + i, std::uint64_t(7 + i), 50 + i, IMUNOISE_SAMPLE_AFTER_GAP})
          .set(0, -5 * i)
          .set(1, 0.25 * i)
          .set(2, std::int64_t{1} << 60);
    }
  }}));
  ASSERT_TRUE(device) << device.error().message;
  EXPECT_EQ((*device)->info().product, "pretend");
  SampleBlock block = (*device)->make_block(2);
  ASSERT_EQ(*(*device)->read(1s, block), ReadOutcome::kSamples);
  ASSERT_EQ(block.rows(), 2U);  // as many as fit
  EXPECT_EQ(block.stream().name, "imu");
  EXPECT_EQ(block.host_time_ns()[1], 1001);
  EXPECT_EQ(block.counter()[1], 8U);
  EXPECT_EQ(block.device_time_ns()[1], 51);
  EXPECT_EQ(block.flags()[1], std::uint32_t{IMUNOISE_SAMPLE_AFTER_GAP});
  EXPECT_EQ(block.column<std::int16_t>(0)[1], -5);
  EXPECT_EQ(block.column<float>(1)[1], 0.25F);
  EXPECT_EQ(block.column<std::int64_t>(2)[0], std::int64_t{1} << 60);
  ASSERT_EQ(*(*device)->read(1s, block), ReadOutcome::kSamples);
  ASSERT_EQ(block.rows(), 1U);  // the rest
  EXPECT_EQ(block.column<std::int16_t>(0)[0], -10);
  EXPECT_EQ(*(*device)->read(1s, block), ReadOutcome::kEnd);
  EXPECT_EQ(*(*device)->read(1s, block), ReadOutcome::kEnd);
}

TEST(DriverBase, StreamsTakeTurns) {
  const auto device = testing::open(steps({[](Samples& samples) {
    for (int i = 0; i < 4; ++i) samples.add(0, {}).set(0, i).set(1, 0).set(2, 0);
    samples.add(1, {}).set(0, 20.5);
  }}));
  SampleBlock block = (*device)->make_block(1);
  std::string order;
  while (*(*device)->read(1s, block) == ReadOutcome::kSamples) order += block.stream().name[0];
  EXPECT_EQ(order, "isiii");
}

TEST(DriverBase, AccountsForEverySampleOfEveryChannel) {
  const auto device = testing::open(steps({[](Samples& samples) {
    samples.add(0, {}).set(0, 1).set(1, 2).set(2, 3);
    samples.add(0, {}).set(0, 40000).set(1, 2).set(2, 3);  // does not fit an int16
    samples.add(0, {}).set(0, 1).set(1, std::numeric_limits<double>::quiet_NaN()).set(2, 3);
    samples.add(0, {}).set(0, 1).set(1, 1e300).set(2, 3);  // does not fit a float
    plugin::Row stale = samples.add(0, {});
    stale.refuse(0, Reason::kStale);
    stale.refuse(1, Reason::kFault);
    samples.add(0, {}).set(0, 9).set(1, 2).set(2, 3);
    samples.refuse(0, Reason::kChecksum, 5);
    samples.refuse(1, Reason::kMalformed);
  }}));
  SampleBlock block = (*device)->make_block(16);
  ASSERT_EQ(*(*device)->read(1s, block), ReadOutcome::kSamples);
  ASSERT_EQ(block.stream_index(), 0U);
  ASSERT_EQ(block.rows(), 2U);
  EXPECT_EQ(block.column<std::int16_t>(0)[1], 9);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    std::uint64_t sum = block.rows();
    for (std::size_t k = 0; k < IMUNOISE_REFUSED_REASONS; ++k) sum += block.refused(k, channel);
    EXPECT_EQ(sum, 11U) << channel;
    EXPECT_EQ(block.refused(IMUNOISE_REFUSED_CHECKSUM, channel), 5U);
  }
  EXPECT_EQ(block.refused(IMUNOISE_REFUSED_OUT_OF_RANGE, 0), 1U);
  EXPECT_EQ(block.refused(IMUNOISE_REFUSED_OUT_OF_RANGE, 1), 2U);
  EXPECT_EQ(block.refused(IMUNOISE_REFUSED_STALE, 0), 1U);
  EXPECT_EQ(block.refused(IMUNOISE_REFUSED_FAULT, 1), 1U);
  EXPECT_EQ(block.refused(IMUNOISE_REFUSED_SIBLING, 2), 4U);
  ASSERT_EQ(*(*device)->read(1s, block), ReadOutcome::kSamples);  // refusals alone are news
  EXPECT_EQ(block.stream_index(), 1U);
  EXPECT_EQ(block.rows(), 0U);
  EXPECT_EQ(block.refused(IMUNOISE_REFUSED_MALFORMED, 0), 1U);
  EXPECT_EQ(block.refused(IMUNOISE_REFUSED_CHECKSUM, 0), 0U);  // told once
  EXPECT_EQ(*(*device)->read(1s, block), ReadOutcome::kEnd);
}

TEST(DriverBase, FillsWholeColumns) {
  const auto device = testing::open(steps({[](Samples& samples) {
    samples.add(0, {}).set(0, 1).set(1, 1).set(2, 1);
    plugin::Rows rows = samples.add_many(0, 3);
    for (std::size_t i = 0; i < 3; ++i) {
      rows.stamps()[i].counter = 100 + i;
      rows.column<std::int16_t>(0)[i] = static_cast<std::int16_t>(i);
      rows.column<float>(1)[i] = 0.5F;
    }
    EXPECT_THROW(rows.column<double>(1), std::logic_error);
  }}));
  SampleBlock block = (*device)->make_block(8);
  ASSERT_EQ(*(*device)->read(1s, block), ReadOutcome::kSamples);
  ASSERT_EQ(block.rows(), 4U);
  EXPECT_EQ(block.counter()[3], 102U);
  EXPECT_EQ(block.column<std::int16_t>(0)[0], 1);
  EXPECT_EQ(block.column<std::int16_t>(0)[3], 2);
  EXPECT_EQ(block.column<std::int64_t>(2)[3], 0);
}

TEST(DriverBase, DeliversWhatCameBeforeAnError) {
  const auto device = testing::open(steps({
      [](Samples& samples) {
        samples.add(1, {}).set(0, 1.5);
        throw plugin::DeviceError(IMUNOISE_DISCONNECTED, "cable out");
      },
      [](Samples& samples) { samples.add(1, {}).set(0, 2.5); },
      [](Samples&) { throw std::runtime_error("surprise"); },
      [](Samples& samples) { samples.add(1, {}).set(1, 0.0); },  // there is no channel 1
      [](Samples&) { throw 7; },
  }));
  SampleBlock block = (*device)->make_block(8);
  ASSERT_EQ(*(*device)->read(1s, block), ReadOutcome::kSamples);
  EXPECT_EQ(block.column<double>(0)[0], 1.5);
  ASSERT_EQ(*(*device)->read(1s, block), ReadOutcome::kDisconnected);
  EXPECT_EQ((*device)->disconnection(), "driver pretend: cable out");
  ASSERT_EQ(*(*device)->read(1s, block), ReadOutcome::kSamples);  // it is back
  EXPECT_EQ(block.column<double>(0)[0], 2.5);
  EXPECT_EQ((*device)->read(1s, block).error().message, "driver pretend: surprise");
}

TEST(DriverBase, AnErrorOfOpenReachesTheUser) {
  testing::Pretend pretend = steps({});
  pretend.opening = [](const plugin::Host&) {
    throw plugin::DeviceError(IMUNOISE_NOT_FOUND, "no device with serial 7; plug it in");
  };
  EXPECT_EQ(testing::open(pretend).error().message,
            "driver pretend: no device with serial 7; plug it in");
  pretend.opening = [](const plugin::Host&) { throw 7; };
  EXPECT_NE(testing::open(pretend).error().message.find("not a std::exception"), std::string::npos);
}

TEST(DriverBase, HostTellsTimeAndTakesNotes) {
  testing::Pretend pretend = steps({});
  std::int64_t now = 0;
  pretend.opening = [&](const plugin::Host& host) {
    now = host.now_ns();
    host.note("reset after 3 bad checksums");
  };
  std::string note;
  const auto before = std::chrono::system_clock::now().time_since_epoch();
  const auto device = testing::open(pretend, [&](std::string_view text) { note = text; });
  const auto after = std::chrono::system_clock::now().time_since_epoch();
  ASSERT_TRUE(device);
  EXPECT_EQ(note, "reset after 3 bad checksums");
  EXPECT_GE(now, std::chrono::nanoseconds(before).count());
  EXPECT_LE(now, std::chrono::nanoseconds(after).count());
}

TEST(DriverBase, AWireIsTappedOnlyWhereTheHostWantsIt) {
  std::string wire;
  drivers::DeviceHandlers keeps = {{},
                                   [&](auto bytes) { wire.append(bytes.begin(), bytes.end()); }};
  const plugin::WireTap tap = plugin::Host(&drivers::host_services(), &keeps).wire_tap();
  ASSERT_TRUE(tap);
  tap(std::vector<std::uint8_t>{'F', 'A'});
  tap(std::vector<std::uint8_t>{'F', 'F'});
  EXPECT_EQ(wire, "FAFF");

  drivers::DeviceHandlers wants_none;
  EXPECT_FALSE(plugin::Host(&drivers::host_services(), &wants_none).wire_tap());

  imunoise_host older = drivers::host_services();  // from before there were wires
  older.size = offsetof(imunoise_host, wire);
  older.wire = nullptr;
  EXPECT_FALSE(plugin::Host(&older, &keeps).wire_tap());
}

// Waits for an answer that never comes.
void wait_in_vain(const plugin::Host& host) {
  const Wait wait(host.opening(), 1min);
  wait.until(wait.deadline());
  throw plugin::DeviceError(wait.cancelled() ? IMUNOISE_CANCELLED : IMUNOISE_NOT_FOUND,
                            wait.cancelled() ? "cancelled" : "no answer");
}

TEST(DriverBase, AnOpeningEndsOnceNobodyWantsTheDevice) {
  for (const auto after : {0ms, 100ms}) {
    std::stop_source stop;
    if (after == 0ms) stop.request_stop();
    const std::jthread stopper([&] {
      std::this_thread::sleep_for(after);
      stop.request_stop();
    });
    const auto begin = Wait::Clock::now();
    const auto device = testing::open({two_streams(), {}, &wait_in_vain}, {}, stop.get_token());
    ASSERT_FALSE(device.has_value());
    EXPECT_EQ(device.error().message, "driver pretend: cancelled");
    EXPECT_LT(Wait::Clock::now() - begin, 10s);
  }
}

TEST(DriverBase, AnOpenDeviceCaresNoMoreForItsOpening) {
  std::stop_source stop;
  std::optional<plugin::Host> host;
  testing::Pretend pretend = steps({[](Samples& samples) { samples.add(1, {}).set(0, 1.0); }});
  pretend.opening = [&](const plugin::Host& of) { host = of; };
  const auto device = testing::open(pretend, {}, stop.get_token());
  ASSERT_TRUE(device) << device.error().message;
  stop.request_stop();
  EXPECT_FALSE(host->opening().is_set());
  SampleBlock block = (*device)->make_block(1);
  EXPECT_EQ(*(*device)->read(1s, block), ReadOutcome::kSamples);
}

TEST(DriverBase, AnOlderHostWaitsForEveryOpening) {
  imunoise_host older = drivers::host_services();
  older.size = offsetof(imunoise_host, while_opening);
  older.while_opening = nullptr;
  drivers::DeviceHandlers handlers;
  const plugin::Host host(&older, &handlers);
  const plugin::Opening opening(host);
  EXPECT_FALSE(host.opening().is_set());
}

TEST(DriverBase, AsksOnceWhereTheHostDoesNotWait) {
  int asked = 0;
  const auto device = testing::open({two_streams(), [&](Samples& samples, const Wait& wait) {
                                       EXPECT_TRUE(wait.over());
                                       if (++asked == 3) samples.add(1, {}).set(0, 1.0);
                                     }});
  SampleBlock block = (*device)->make_block(1);
  EXPECT_EQ(*(*device)->read(0ms, block), ReadOutcome::kTimeout);
  EXPECT_EQ(*(*device)->read(0ms, block), ReadOutcome::kTimeout);
  EXPECT_EQ(*(*device)->read(0ms, block), ReadOutcome::kSamples);
  EXPECT_EQ(asked, 3);
}

TEST(DriverBase, WaitsUntilTheDeadlineAndNotLonger) {
  const auto device = testing::open({two_streams(), [&](Samples&, const Wait& wait) {
                                       EXPECT_FALSE(wait.until(wait.deadline() + 1h));
                                       EXPECT_FALSE(wait.cancelled());
                                     }});
  SampleBlock block = (*device)->make_block(1);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(*(*device)->read(30ms, block), ReadOutcome::kTimeout);
  const auto took = std::chrono::steady_clock::now() - start;
  EXPECT_GE(took, 30ms);
  EXPECT_LT(took, 30s);
}

TEST(DriverBase, WakesWhenADescriptorCanBeRead) {
  int pipe_ends[2];
  ASSERT_EQ(::pipe(pipe_ends), 0);
  const auto device = testing::open({two_streams(), [&](Samples& samples, const Wait& wait) {
                                       if (wait.ready(pipe_ends[0])) samples.end();
                                     }});
  SampleBlock block = (*device)->make_block(1);
  EXPECT_EQ(*(*device)->read(1ms, block), ReadOutcome::kTimeout);
  ASSERT_EQ(::write(pipe_ends[1], "x", 1), 1);
  EXPECT_EQ(*(*device)->read(1h, block), ReadOutcome::kEnd);
  ::close(pipe_ends[0]);
  ::close(pipe_ends[1]);
}

TEST(DriverBase, CancelEndsAReadThatWaitsAndAllLaterOnes) {
  std::atomic<bool> reading = false;
  const auto device = testing::open({two_streams(), [&](Samples&, const Wait& wait) {
                                       reading = true;
                                       EXPECT_FALSE(wait.until(wait.deadline()));
                                       EXPECT_TRUE(wait.over());
                                     }});
  SampleBlock block = (*device)->make_block(1);
  std::jthread canceller([&] {
    while (!reading) std::this_thread::yield();
    (*device)->cancel();
    (*device)->cancel();
  });
  EXPECT_EQ(*(*device)->read(1h, block), ReadOutcome::kCancelled);
  EXPECT_EQ(*(*device)->read(1h, block), ReadOutcome::kCancelled);
}

TEST(DriverBase, CancelInterruptsAReadThatWaitsInItsOwnWay) {
  std::mutex mutex;
  std::condition_variable changed;
  bool reading = false;
  bool interrupted = false;
  testing::Pretend pretend = {two_streams(), [&](Samples&, const Wait&) {
                                std::unique_lock lock(mutex);
                                reading = true;
                                changed.notify_all();
                                changed.wait(lock, [&] { return interrupted; });
                              }};
  pretend.interrupt = [&] {
    const std::scoped_lock lock(mutex);
    interrupted = true;
    changed.notify_all();
  };
  const auto device = testing::open(pretend);
  std::jthread canceller([&] {
    std::unique_lock lock(mutex);
    changed.wait(lock, [&] { return reading; });
    lock.unlock();
    (*device)->cancel();
  });
  SampleBlock block = (*device)->make_block(1);
  EXPECT_EQ(*(*device)->read(1h, block), ReadOutcome::kCancelled);
}

}  // namespace
}  // namespace imunoise
