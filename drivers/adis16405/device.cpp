#include "drivers/adis16405/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace imunoise::drivers::adis16405 {
namespace {

using namespace std::chrono_literals;
using plugin::DeviceError;
using plugin::Wait;

constexpr usb::Duration kStep = 50ms;  // between looks at a cancel
constexpr auto kSearchPeriod = 200ms;
constexpr usb::Duration kMostSilence = 1s;
constexpr double kMostSilentSamples = 10.0;  // where these take longer

std::vector<usb::Id> wanted_ids(const std::string& bridge) {
  if (bridge == "ft232h") return {kFt232hId};
  if (bridge == "cp2130") return {kCp2130Id};
  return {kFt232hId, kCp2130Id};
}

// Starts the sensor before anything is read of it.
SpiBus& started(SpiBus& bus, const Settings& settings, const Note& note) {
  Sensor(bus).start(settings, note);
  return bus;
}

usb::Duration most_silence(const Settings& settings) {
  const std::chrono::duration<double> samples(kMostSilentSamples /
                                              sample_rate(settings.sample_period).value);
  return std::max(kMostSilence, std::chrono::duration_cast<usb::Duration>(samples));
}

}  // namespace

Adis16405Device::Connection::Connection(std::unique_ptr<usb::Handle> usb, usb::Id id,
                                        const Choice& choice, const Note& note,
                                        const plugin::WireTap& wire)
    : bus(std::move(usb), make_bridge(id)),
      reader(started(bus, choice.settings, note), choice.settings,
             choice.poll || !bus.bridge().sees_data_ready(), note, wire) {}

Adis16405Device::Adis16405Device(std::shared_ptr<usb::Bus> bus, Choice choice,
                                 const plugin::Host& host)
    : usb_(std::move(bus)),
      choice_(std::move(choice)),
      note_([host](const std::string& text) { host.note(text); }),
      wire_(host.wire_tap()),
      address_(choose()) {
  connect(address_);
}

usb::Address Adis16405Device::choose() {
  std::vector<usb::Address> found = usb_->find(wanted_ids(choice_.bridge));
  std::string there;
  for (const usb::Address& address : found) there += "; " + usb::describe(address);
  if (!choice_.serial.empty()) {
    std::erase_if(found, [&](const usb::Address& a) { return a.serial != choice_.serial; });
  }
  if (found.size() == 1) return found.front();
  if (!found.empty()) {
    throw DeviceError(IMUNOISE_BAD_OPTION,
                      "ADIS16405: several USB-SPI bridges are plugged in: choose one by "
                      "serial=NUMBER" +
                          there);
  }
  throw DeviceError(
      IMUNOISE_NOT_FOUND,
      fmt::format("ADIS16405: no USB-SPI bridge{}{} is plugged in (FT232H 0403:6014, "
                  "CP2130 10c4:87a0); look at its cable, its permission, and lsusb{}",
                  choice_.serial.empty() ? "" : " with serial number ", choice_.serial, there));
}

void Adis16405Device::connect(const usb::Address& address) {
  connection_.reset();
  connection_ =
      std::make_unique<Connection>(usb_->open(address), address.id, choice_, note_, wire_);
  address_ = address;
}

DeviceInfo Adis16405Device::describe() {
  return {describe_streams(choice_.settings), "ADIS16405", address_.serial};
}

void Adis16405Device::read(plugin::Samples& samples, const Wait& wait) {
  if (!connection_) return look_for_it(wait);
  const usb::Duration left = wait.deadline() - Wait::Clock::now();
  try {
    connection_->reader.read(samples, std::clamp(left, usb::Duration(0), kStep));
    if (connection_->reader.silence() > most_silence(choice_.settings)) restart();
  } catch (const DeviceError& error) {
    lose(error.what());
  }
}

void Adis16405Device::restart() {
  note_(
      fmt::format("ADIS16405: no sample for {:g} s; it is started again. Is DIO1 wired to the "
                  "bridge's data-ready pin (FT232H: ADBUS5)?",
                  std::chrono::duration<double>(most_silence(choice_.settings)).count()));
  connect(address_);
}

void Adis16405Device::lose(const std::string& why) {
  connection_.reset();
  why_lost_ = why;
  throw DeviceError(IMUNOISE_DISCONNECTED, why);
}

// The bridge may come back at another port, but one without a serial number only at its own.
std::optional<usb::Address> Adis16405Device::find_again() {
  for (usb::Address& there : usb_->find(std::array{address_.id})) {
    const bool same =
        address_.serial.empty() ? there.port == address_.port : there.serial == address_.serial;
    if (same) return std::move(there);
  }
  return std::nullopt;
}

void Adis16405Device::look_for_it(const Wait& wait) {
  do {
    try {
      if (const auto address = find_again()) {
        connect(*address);
        return note_("ADIS16405: is back: " + usb::describe(address_));
      }
    } catch (const DeviceError& error) {
      why_lost_ = error.what();  // e.g. udev has not given permission yet
    }
  } while (wait.until(Wait::Clock::now() + kSearchPeriod));
  lose(why_lost_);
}

}  // namespace imunoise::drivers::adis16405
