#include "drivers/emulator/usb/usb_answers.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace imunoise::emulator {
namespace {

using ByteVector = std::vector<std::uint8_t>;

constexpr std::size_t kAnswerBytes = 4;  // shorter packets may hold no answer

enum StringIndex : std::uint8_t { kLanguages, kMaker, kProduct, kSerial };
enum RequestType : std::uint8_t { kVendorOut = 0x40, kToHost = 0x80, kKind = 0x60 };
enum Standard : std::uint8_t { kClearFeature = 1, kGetDescriptor = 6 };
enum Descriptor : std::uint8_t { kDevice = 1, kConfiguration = 2, kString = 3 };

void append_little_endian(ByteVector& out, unsigned value) {
  out.push_back(static_cast<std::uint8_t>(value & 0xffU));
  out.push_back(static_cast<std::uint8_t>(value >> 8U));
}

ByteVector string_descriptor(std::string_view text) {
  ByteVector out = {static_cast<std::uint8_t>(2 + 2 * text.size()), kString};
  for (const char letter : text) append_little_endian(out, static_cast<unsigned char>(letter));
  return out;
}

std::optional<ByteVector> descriptor(const UsbIdentity& identity, unsigned type, unsigned index) {
  if (type == kDevice) return device_descriptor(identity);
  if (type == kConfiguration) return configuration_descriptor(identity);
  if (type != kString) return std::nullopt;
  switch (index) {
    case kLanguages:
      return ByteVector{4, kString, 0x09, 0x04};  // English
    case kMaker:
      return string_descriptor("imunoise");
    case kProduct:
      return string_descriptor("emulated USB-SPI bridge");
    case kSerial:
      return string_descriptor(identity.serial);
    default:
      return std::nullopt;
  }
}

}  // namespace

ByteVector device_descriptor(const UsbIdentity& identity) {
  ByteVector out = {18, kDevice, 0x00, 0x02, 0, 0, 0, 64};
  append_little_endian(out, identity.id.vendor);
  append_little_endian(out, identity.id.product);
  append_little_endian(out, 0x0900);
  out.insert(out.end(), {kMaker, kProduct, kSerial, 1});
  return out;
}

ByteVector configuration_descriptor(const UsbIdentity& identity) {
  ByteVector out = {9, kConfiguration, 32, 0, 1, 1, 0, 0x80, 50};
  out.insert(out.end(), {9, 4, 0, 0, 2, 0xff, 0xff, 0xff, 0});
  for (const std::uint8_t endpoint : {identity.in_endpoint, identity.out_endpoint}) {
    out.insert(out.end(), {7, 5, endpoint, 2});
    append_little_endian(out, identity.packet_bytes);
    out.push_back(0);
  }
  return out;
}

bool lose_byte_of(ByteVector& packet) {
  if (packet.size() < kAnswerBytes) return false;
  packet.erase(packet.end() - 2);
  return true;
}

UsbAnswers::Completed UsbAnswers::control(Id id, const UsbSetup& setup, drivers::Bytes data) {
  const auto answered = answer(setup, data);
  if (!answered) return {id, true, 0, {}};
  const std::size_t most = setup[6] | setup[7] * 256U;
  Completed out{id, false, data.size(), *answered};
  out.received.resize(std::min(most, out.received.size()));
  return out;
}

std::optional<ByteVector> UsbAnswers::answer(const UsbSetup& setup, drivers::Bytes data) {
  const unsigned value = setup[2] | setup[3] * 256U;
  const unsigned index = setup[4] | setup[5] * 256U;
  if (setup[0] == kVendorOut) {
    const bool accepted = peripheral_.control({setup[1],
                                               static_cast<std::uint16_t>(value),
                                               static_cast<std::uint16_t>(index),
                                               {data.begin(), data.end()}});
    return accepted ? std::optional(ByteVector{}) : std::nullopt;
  }
  if ((setup[0] & kKind) != 0) return std::nullopt;  // of a class or the maker: knows no others
  if ((setup[0] & kToHost) == 0) {
    if (setup[1] == kClearFeature && index == peripheral_.identity().in_endpoint)
      in_halted_ = false;
    return ByteVector{};
  }
  if (setup[1] == kGetDescriptor) {
    return descriptor(peripheral_.identity(), value >> 8U, value & 0xffU);
  }
  return ByteVector{0, 0};  // status
}

bool UsbAnswers::discard(Id id) {
  if (std::erase(in_, id) > 0) return true;
  return std::erase_if(out_, [&](const Out& transfer) { return transfer.id == id; }) > 0;
}

std::vector<UsbAnswers::Id> UsbAnswers::discard_all() {
  std::vector<Id> out(in_.begin(), in_.end());
  for (const Out& transfer : out_) out.push_back(transfer.id);
  in_.clear();
  out_.clear();
  return out;
}

void UsbAnswers::pass(Time end, std::vector<Completed>& completed) {
  exchange(completed);
  peripheral_.run(end);
  exchange(completed);
}

void UsbAnswers::exchange(std::vector<Completed>& completed) {
  while (!out_.empty()) {
    Out& first = out_.front();
    first.done += peripheral_.out(drivers::Bytes(first.bytes).subspan(first.done));
    if (first.done < first.bytes.size()) break;
    completed.push_back({first.id, false, first.bytes.size(), {}});
    out_.pop_front();
  }
  while (in_halted_ && !in_.empty()) {
    completed.push_back({in_.front(), true, 0, {}});
    in_.pop_front();
  }
  if (in_.empty()) return;
  if (auto packet = peripheral_.in()) {
    if (loses_byte_) loses_byte_ = !lose_byte_of(*packet);
    completed.push_back({in_.front(), false, 0, std::move(*packet)});
    in_.pop_front();
  }
}

}  // namespace imunoise::emulator
