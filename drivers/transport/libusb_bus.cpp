#include "drivers/transport/libusb_bus.h"

#include <fmt/format.h>
#include <libusb.h>

#include <algorithm>
#include <array>

#include "drivers/plugin/device.h"
#include "drivers/transport/libusb_device.h"

namespace imunoise::drivers::usb {
namespace {

using plugin::DeviceError;

libusb_context* make_context() {
  libusb_context* context = nullptr;
  const int error = libusb_init(&context);
  if (error != LIBUSB_SUCCESS) {
    throw DeviceError(IMUNOISE_FAILED,
                      fmt::format("USB: {}; is /dev/bus/usb there?", libusb_strerror(error)));
  }
  return context;
}

// The devices that are plugged in, as libusb hands them out.
class DeviceList {
 public:
  explicit DeviceList(libusb_context* context)
      : count_(std::max<ssize_t>(0, libusb_get_device_list(context, &devices_))) {}
  DeviceList(const DeviceList&) = delete;
  DeviceList& operator=(const DeviceList&) = delete;
  ~DeviceList() {
    if (devices_ != nullptr) libusb_free_device_list(devices_, 1);
  }
  std::span<libusb_device* const> all() const {
    return {devices_, static_cast<std::size_t>(count_)};
  }

 private:
  libusb_device** devices_ = nullptr;
  ssize_t count_;
};

Id id_of(libusb_device* device) {
  libusb_device_descriptor descriptor{};
  libusb_get_device_descriptor(device, &descriptor);
  return {descriptor.idVendor, descriptor.idProduct};
}

std::string port_of(libusb_device* device) {
  constexpr int kMostPorts = 7;  // USB 3.0 specification: hubs behind hubs end there
  std::array<std::uint8_t, kMostPorts> ports{};
  const int count = libusb_get_port_numbers(device, ports.data(), kMostPorts);
  std::string out = fmt::format("{}", libusb_get_bus_number(device));
  for (int i = 0; i < count; ++i) {
    out += fmt::format("{}{}", i == 0 ? '-' : '.', ports[static_cast<std::size_t>(i)]);
  }
  return out;
}

// Empty where there is none, or the device may not be opened.
std::string serial_of(libusb_device* device) {
  libusb_device_descriptor descriptor{};
  libusb_get_device_descriptor(device, &descriptor);
  libusb_device_handle* opened = nullptr;
  if (descriptor.iSerialNumber == 0 || libusb_open(device, &opened) != LIBUSB_SUCCESS) return "";
  const LibusbHandle handle(opened, &libusb_close);
  std::array<unsigned char, 128> text{};
  const int length = libusb_get_string_descriptor_ascii(handle.get(), descriptor.iSerialNumber,
                                                        text.data(), text.size());
  return length > 0 ? std::string(text.begin(), text.begin() + length) : "";
}

LibusbHandle open_handle(libusb_device* device, const Address& address) {
  libusb_device_handle* opened = nullptr;
  const int error = libusb_open(device, &opened);
  if (error == LIBUSB_ERROR_ACCESS) {
    throw DeviceError(IMUNOISE_NO_ACCESS, describe(address) +
                                              ": no permission to open it; a udev rule gives it "
                                              "(TAG+=\"uaccess\", or GROUP for a service)");
  }
  if (error != LIBUSB_SUCCESS) {
    throw DeviceError(IMUNOISE_NOT_FOUND, fmt::format("{}: {}; plug it in again", describe(address),
                                                      libusb_strerror(error)));
  }
  return {opened, &libusb_close};
}

}  // namespace

LibusbBus::LibusbBus(HostClock clock)
    : clock_(std::move(clock)), context_(make_context(), &libusb_exit) {}

std::vector<Address> LibusbBus::find(std::span<const Id> ids) {
  const DeviceList list(context_.get());
  std::vector<Address> out;
  for (libusb_device* const device : list.all()) {
    const Id id = id_of(device);
    if (std::find(ids.begin(), ids.end(), id) == ids.end()) continue;
    out.push_back({id, port_of(device), serial_of(device)});
  }
  return out;
}

std::unique_ptr<Handle> LibusbBus::open(const Address& address) {
  const DeviceList list(context_.get());
  for (libusb_device* const device : list.all()) {
    if (id_of(device) == address.id && port_of(device) == address.port) {
      return std::make_unique<LibusbDevice>(context_, open_handle(device, address), address,
                                            clock_);
    }
  }
  throw DeviceError(IMUNOISE_NOT_FOUND, describe(address) + ": was unplugged; plug it in again");
}

}  // namespace imunoise::drivers::usb
