#include "tests/drivers/adis16405/rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "drivers/emulator/usb/cp2130.h"
#include "drivers/emulator/usb/ft232h.h"
#include "drivers/host/services.h"
#include "tests/drivers/host/pretend_driver.h"

namespace imunoise::testing {
namespace {

using namespace std::chrono_literals;
using emulator::Measurement;

constexpr std::int64_t kStartNs = 1'700'000'000'000'000'000;
constexpr std::uint64_t kSeed = 20240611;

// Numbers that differ from channel to channel, with noise of tens of counts, so that two samples
// are never alike and no channel can be taken for another.
const Measurement kMean{{0.1, -0.2, 0.3}, {1.0, -3.0, 9.8}, {2e-5, -1e-5, 4e-5}, 308.0, 5.01, 1.2};
const Measurement kDeviation{
    {0.05, 0.05, 0.05}, {2.0, 2.0, 2.0}, {4e-6, 4e-6, 4e-6}, 3.0, 0.05, 0.05};

std::unique_ptr<emulator::UsbPeripheral> make_peripheral(drivers::usb::Id id,
                                                         emulator::SpiSlave& sensor) {
  if (id == drivers::adis16405::kCp2130Id) {
    return std::make_unique<emulator::Cp2130>(sensor, "CP0001");
  }
  return std::make_unique<emulator::Ft232h>(sensor, "FT0001");
}

}  // namespace

const std::array<std::vector<std::size_t>, 3> kPositions = {
    {{1, 2, 3, 4, 5, 6}, {7, 8, 9}, {0, 10, 11}}};

std::size_t Received::flagged(std::uint32_t flag) const {
  return static_cast<std::size_t>(
      std::count_if(flags.begin(), flags.end(), [&](std::uint32_t f) { return (f & flag) != 0; }));
}

Rig::Rig(drivers::usb::Id bridge_id) : Rig(bridge_id, kMean, kDeviation) {}

Rig::Rig(const Measurement& constant) : Rig(drivers::adis16405::kFt232hId, constant, {}) {}

Rig::Rig(drivers::usb::Id bridge_id, const Measurement& mean, const Measurement& deviation)
    : source(mean, deviation, kSeed),
      sensor(source, kSeed),
      bridge(make_peripheral(bridge_id, sensor)),
      bus(*bridge, kStartNs),
      handlers{[this](std::string_view text) { notes.emplace_back(text); }, {}} {}

void Rig::open(const drivers::adis16405::Choice& choice) {
  device.reset();
  const std::shared_ptr<drivers::usb::Bus> borrowed(std::shared_ptr<void>(), &bus);
  driver = std::make_unique<drivers::adis16405::Adis16405Device>(
      borrowed, choice, plugin::Host(&drivers::host_services(), &handlers));
  auto opened =
      testing::open({driver->describe(), [&](plugin::Samples& samples, const plugin::Wait& wait) {
                       driver->read(samples, wait);
                     }});
  ASSERT_TRUE(opened) << opened.error().message;
  device = std::move(*opened);
}

drivers::ReadOutcome Rig::read(std::size_t imu_samples) {
  drivers::SampleBlock block = device->make_block(512);
  while (received[kImu].rows.size() < imu_samples) {
    const auto outcome = device->read(10s, block);
    EXPECT_TRUE(outcome) << outcome.error().message;
    if (!outcome || *outcome != drivers::ReadOutcome::kSamples) {
      return outcome.value_or(drivers::ReadOutcome::kEnd);
    }
    append(block, received);
  }
  return drivers::ReadOutcome::kSamples;
}

std::vector<Counts> Rig::taken(Stream stream) const {
  std::vector<Counts> out;
  for (const emulator::TakenSample& sample : sensor.taken()) {
    Counts& row = out.emplace_back();
    for (const std::size_t position : kPositions[stream]) row.push_back(sample.counts[position]);
  }
  return out;
}

bool Rig::noted(const std::string& text) const {
  return std::any_of(notes.begin(), notes.end(),
                     [&](const std::string& note) { return note.find(text) != std::string::npos; });
}

void append(const drivers::SampleBlock& block, std::array<Received, 3>& received) {
  Received& to = received[block.stream_index()];
  const std::size_t channels = block.stream().channels.size();
  for (std::size_t i = 0; i < block.rows(); ++i) {
    Counts& row = to.rows.emplace_back();
    for (std::size_t c = 0; c < channels; ++c) row.push_back(block.column<std::int16_t>(c)[i]);
    to.times.push_back(block.host_time_ns()[i]);
    to.flags.push_back(block.flags()[i]);
  }
  for (std::size_t reason = 0; reason < to.refused.size(); ++reason) {
    to.refused[reason] += block.refused(reason, 0);
    for (std::size_t c = 1; c < channels; ++c) {
      EXPECT_EQ(block.refused(reason, c), block.refused(reason, 0));
    }
  }
}

std::size_t expect_stretch(const std::vector<Counts>& part, const std::vector<Counts>& all) {
  const auto first = part.empty() ? all.end() : std::find(all.begin(), all.end(), part.front());
  const auto before = static_cast<std::size_t>(first - all.begin());
  EXPECT_GE(all.size() - before, part.size());
  for (std::size_t i = 0; i < part.size() && before + i < all.size(); ++i) {
    EXPECT_EQ(part[i], all[before + i]) << "sample " << i;
    if (part[i] != all[before + i]) break;
  }
  return before;
}

std::size_t expect_in_order(const std::vector<Counts>& part, const std::vector<Counts>& all) {
  std::size_t holes = 0;
  auto next = all.begin();
  for (std::size_t i = 0; i < part.size(); ++i) {
    const auto found = std::find(next, all.end(), part[i]);
    EXPECT_NE(found, all.end()) << "sample " << i << " was never taken, or twice delivered";
    if (found == all.end()) return holes;
    if (i > 0 && found != next) ++holes;
    next = found + 1;
  }
  return holes;
}

}  // namespace imunoise::testing
