#include "drivers/transport/libusb_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>
#include <utility>

#include "drivers/plugin/device.h"

namespace imunoise::drivers::usb {
namespace {

using plugin::DeviceError;
using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr int kInterface = 0;
constexpr std::uint8_t kVendorRequestOut = 0x40;
constexpr unsigned kControlTimeoutMs = 1000;
constexpr Duration kCancelTime = 1s;  // the kernel gives cancelled transfers back at once

std::string_view meaning(libusb_transfer_status status) {
  switch (status) {
    case LIBUSB_TRANSFER_NO_DEVICE:
      return "unplugged";
    case LIBUSB_TRANSFER_STALL:
      return "it refuses a transfer";
    case LIBUSB_TRANSFER_OVERFLOW:
      return "it sent more than was asked for";
    default:
      return "transfers fail (unplugged, or a bad cable)";
  }
}

}  // namespace

LibusbDevice::LibusbDevice(std::shared_ptr<libusb_context> context, LibusbHandle handle,
                           Address address, HostClock clock)
    : context_(std::move(context)),
      handle_(std::move(handle)),
      address_(std::move(address)),
      clock_(std::move(clock)) {
  claim();
  find_endpoints();
  for (std::size_t i = 0; i < kTransfersInFlight; ++i) {
    Slot& slot = add_slot(in_);
    slot.bytes.resize(kTransferBytes);
    submit(slot, in_endpoint_);
  }
}

LibusbDevice::~LibusbDevice() {
  closing_ = true;
  cancel(out_);
  cancel(in_);
  // An endpoint stays halted until the host clears it, whoever opens the device next.
  if (halted_) libusb_clear_halt(handle_.get(), *halted_);
  libusb_release_interface(handle_.get(), kInterface);
}

void LibusbDevice::claim() {
  libusb_set_auto_detach_kernel_driver(handle_.get(), 1);  // fails where there are none
  const int error = libusb_claim_interface(handle_.get(), kInterface);
  if (error == LIBUSB_ERROR_BUSY) {
    throw DeviceError(IMUNOISE_NO_ACCESS,
                      describe(address_) + ": another program uses it; end that one");
  }
  if (error != LIBUSB_SUCCESS) gone(libusb_strerror(error));
}

void LibusbDevice::find_endpoints() {
  libusb_config_descriptor* found = nullptr;
  if (libusb_get_active_config_descriptor(libusb_get_device(handle_.get()), &found) == 0) {
    const std::unique_ptr<libusb_config_descriptor, void (*)(libusb_config_descriptor*)> config(
        found, &libusb_free_config_descriptor);
    const libusb_interface_descriptor& interface = config->interface[kInterface].altsetting[0];
    for (const libusb_endpoint_descriptor& endpoint :
         std::span(interface.endpoint, interface.bNumEndpoints)) {
      if ((endpoint.bmAttributes & 3U) != LIBUSB_TRANSFER_TYPE_BULK) continue;
      const bool in = (endpoint.bEndpointAddress & LIBUSB_ENDPOINT_IN) != 0;
      std::uint8_t& address = in ? in_endpoint_ : out_endpoint_;
      if (address == 0) address = endpoint.bEndpointAddress;
    }
  }
  if (in_endpoint_ == 0 || out_endpoint_ == 0) {
    throw DeviceError(IMUNOISE_BAD_DEVICE,
                      describe(address_) + ": has no bulk endpoints; is it the right device?");
  }
}

LibusbDevice::Slot& LibusbDevice::add_slot(std::list<Slot>& slots) {
  slots.push_back({this, {libusb_alloc_transfer(0), {}}, {}});
  if (!slots.back().transfer) throw std::bad_alloc();
  return slots.back();
}

void LibusbDevice::submit(Slot& slot, std::uint8_t endpoint) {
  libusb_fill_bulk_transfer(slot.transfer.get(), handle_.get(), endpoint, slot.bytes.data(),
                            static_cast<int>(slot.bytes.size()), &LibusbDevice::completed, &slot,
                            0);
  const int error = libusb_submit_transfer(slot.transfer.get());
  slot.in_flight = error == LIBUSB_SUCCESS;
  if (!slot.in_flight && !failure_) failure_ = libusb_strerror(error);
}

void LIBUSB_CALL LibusbDevice::completed(libusb_transfer* transfer) {
  auto& slot = *static_cast<Slot*>(transfer->user_data);
  slot.in_flight = false;
  slot.owner->take(slot);
}

void LibusbDevice::take(Slot& slot) {
  const libusb_transfer& transfer = *slot.transfer;
  if (closing_ || transfer.status == LIBUSB_TRANSFER_CANCELLED) return;
  if (transfer.status != LIBUSB_TRANSFER_COMPLETED) {
    if (!failure_) failure_ = meaning(transfer.status);
    if (transfer.status == LIBUSB_TRANSFER_STALL) halted_ = transfer.endpoint;
  } else if (transfer.endpoint == in_endpoint_) {
    arrived_.push_back(
        {{slot.bytes.begin(), slot.bytes.begin() + transfer.actual_length}, clock_()});
    submit(slot, in_endpoint_);
  }
}

void LibusbDevice::control(const Request& request) {
  std::vector<std::uint8_t> data = request.data;
  const int result = libusb_control_transfer(
      handle_.get(), kVendorRequestOut, request.request, request.value, request.index, data.data(),
      static_cast<std::uint16_t>(data.size()), kControlTimeoutMs);
  if (result >= 0) return;
  if (result == LIBUSB_ERROR_NO_DEVICE || result == LIBUSB_ERROR_IO) gone(libusb_strerror(result));
  throw DeviceError(IMUNOISE_FAILED,
                    fmt::format("{}: request 0x{:02x}: {}; unplug it and plug it in again",
                                describe(address_), request.request, libusb_strerror(result)));
}

void LibusbDevice::send(std::vector<std::uint8_t> bytes) {
  if (failure_) gone(*failure_);
  const auto idle =
      std::find_if(out_.begin(), out_.end(), [](const Slot& slot) { return !slot.in_flight; });
  Slot& slot = idle == out_.end() ? add_slot(out_) : *idle;
  slot.bytes = std::move(bytes);
  submit(slot, out_endpoint_);
}

std::vector<Transfer> LibusbDevice::receive(Duration timeout) {
  const Clock::time_point deadline = Clock::now() + timeout;
  for (bool asked = false;; asked = true) {
    if (!arrived_.empty()) return std::exchange(arrived_, {});
    if (failure_) gone(*failure_);
    const Duration left = deadline - Clock::now();
    if (asked && left <= 0ns) return {};
    handle_events(left);
  }
}

void LibusbDevice::handle_events(Duration most) {
  const auto left =
      std::max<std::int64_t>(0, std::chrono::ceil<std::chrono::microseconds>(most).count());
  timeval time = {left / 1'000'000, left % 1'000'000};
  const int error = libusb_handle_events_timeout_completed(context_.get(), &time, nullptr);
  if (error != LIBUSB_SUCCESS && error != LIBUSB_ERROR_INTERRUPTED && !failure_) {
    failure_ = libusb_strerror(error);
  }
}

void LibusbDevice::cancel(std::list<Slot>& slots) {
  const auto in_flight = [&] {
    return std::any_of(slots.begin(), slots.end(), [](const Slot& slot) { return slot.in_flight; });
  };
  for (Slot& slot : slots) {
    if (slot.in_flight) libusb_cancel_transfer(slot.transfer.get());
  }
  const Clock::time_point deadline = Clock::now() + kCancelTime;
  while (in_flight() && Clock::now() < deadline) handle_events(100ms);
}

Duration LibusbDevice::now() const { return Clock::now().time_since_epoch(); }

void LibusbDevice::sleep(Duration duration) { std::this_thread::sleep_for(duration); }

void LibusbDevice::gone(const std::string& why) const {
  throw DeviceError(IMUNOISE_DISCONNECTED,
                    fmt::format("{}: {}; plug it in again to continue", describe(address_), why));
}

}  // namespace imunoise::drivers::usb
