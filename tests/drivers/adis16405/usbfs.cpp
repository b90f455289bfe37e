#include "tests/drivers/adis16405/usbfs.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <span>
#include <utility>

namespace imunoise::testing {
namespace {

using namespace std::chrono_literals;

constexpr emulator::Time kStep = 2ms;    // that passes where nothing can be reaped
constexpr emulator::Time kPause = 20ms;  // from here on an idle driver paused on purpose

}  // namespace

usbdevfs_urb& UsbFs::Urb::urb() const {
  return *static_cast<usbdevfs_urb*>(static_cast<void*>(data->data));
}
unsigned char* UsbFs::Urb::bytes() const { return static_cast<unsigned char*>(urb().buffer); }

UsbFs::UsbFs(emulator::UsbPeripheral& peripheral)
    : peripheral_(peripheral),
      answers_(peripheral),
      testbed_(umockdev_testbed_new()),
      ioctls_(umockdev_ioctl_base_new()) {
  g_signal_connect(ioctls_.get(), "handle-ioctl", G_CALLBACK(&UsbFs::on_ioctl), this);
  plug();
}

UsbFs::~UsbFs() {
  if (plugged_) unplug();
}

bool UsbFs::available() {
  const char* const preloaded = std::getenv("LD_PRELOAD");
  return preloaded != nullptr && std::strstr(preloaded, "libumockdev-preload") != nullptr;
}

std::string UsbFs::node() const { return fmt::format("bus/usb/001/{:03}", number_); }
std::string UsbFs::path() const { return "/sys/devices/usb1/1-1"; }

void UsbFs::plug() {
  ++number_;
  {
    const auto held = lock();
    peripheral_.power_up();
    plugged_ = true;
  }
  GError* error = nullptr;
  umockdev_testbed_attach_ioctl(testbed_.get(), ("/dev/" + node()).c_str(), ioctls_.get(), &error);
  EXPECT_EQ(error, nullptr) << error->message;
  std::vector<std::uint8_t> bytes = emulator::device_descriptor(peripheral_.identity());
  const auto configuration = emulator::configuration_descriptor(peripheral_.identity());
  bytes.insert(bytes.end(), configuration.begin(), configuration.end());
  std::string hex;
  for (const std::uint8_t byte : bytes) hex += fmt::format("{:02X}", byte);
  const std::string device = fmt::format(
      "P: /devices/usb1/1-1\nN: {0}\nE: SUBSYSTEM=usb\nE: DRIVER=usb\nE: BUSNUM=001\n"
      "E: DEVNUM={1:03}\nE: DEVNAME=/dev/{0}\nE: DEVTYPE=usb_device\nA: bConfigurationValue=1\\n\n"
      "A: busnum=1\\n\nA: devnum={1}\\n\nA: devpath=1\\n\nA: speed=480\\n\nH: descriptors={2}\n\n",
      node(), number_, hex);
  umockdev_testbed_add_from_string(testbed_.get(), device.c_str(), &error);
  EXPECT_EQ(error, nullptr) << error->message;
  umockdev_testbed_uevent(testbed_.get(), path().c_str(), "add");
}

void UsbFs::unplug() {
  {
    const auto held = lock();
    plugged_ = false;
    for (const auto id : answers_.discard_all()) complete(id, -ESHUTDOWN);
  }
  umockdev_testbed_uevent(testbed_.get(), path().c_str(), "remove");
  umockdev_testbed_remove_device(testbed_.get(), path().c_str());
  umockdev_testbed_detach_ioctl(testbed_.get(), ("/dev/" + node()).c_str(), nullptr);
}

void UsbFs::set_busy(bool busy) {
  const auto held = lock();
  busy_ = busy;
}

void UsbFs::halt_in() {
  const auto held = lock();
  answers_.halt_in();
}

gboolean UsbFs::on_ioctl(UMockdevIoctlBase* /*base*/, UMockdevIoctlClient* client, UsbFs* self) {
  const auto held = self->lock();
  const long result =
      self->serve(umockdev_ioctl_client_get_request(client), umockdev_ioctl_client_get_arg(client));
  umockdev_ioctl_client_complete(client, result < 0 ? -1 : result,
                                 static_cast<int>(result < 0 ? -result : 0));
  return TRUE;
}

long UsbFs::serve(unsigned long request, UMockdevIoctlData* argument) {
  const auto now = Clock::now();
  const emulator::Time pause = now - std::exchange(last_call_, now);
  if (request == USBDEVFS_REAPURBNDELAY) return reap(argument);
  if (request == USBDEVFS_DISCARDURB) return discard(argument);
  if (!plugged_) return -ENODEV;
  switch (request) {
    case USBDEVFS_GET_CAPABILITIES: {
      UMockdevIoctlData* const out =
          umockdev_ioctl_data_resolve(argument, 0, sizeof(std::uint32_t), nullptr);
      const std::uint32_t capabilities =
          USBDEVFS_CAP_NO_PACKET_SIZE_LIM | USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
      std::memcpy(out->data, &capabilities, sizeof capabilities);
      return 0;
    }
    case USBDEVFS_CLAIMINTERFACE:
    case USBDEVFS_DISCONNECT_CLAIM:
      return busy_ ? -EBUSY : 0;
    case USBDEVFS_RELEASEINTERFACE:
      return 0;
    case USBDEVFS_GETDRIVER:
      return -ENODATA;
    case USBDEVFS_CLEAR_HALT: {
      unsigned endpoint = 0;
      const UMockdevIoctlData* const in =
          umockdev_ioctl_data_resolve(argument, 0, sizeof endpoint, nullptr);
      std::memcpy(&endpoint, in->data, sizeof endpoint);
      answers_.control(0, {0x02, 1, 0, 0, static_cast<std::uint8_t>(endpoint), 0, 0, 0}, {});
      return 0;
    }
    case USBDEVFS_SUBMITURB:
      return submit(argument, pause);
    default:
      return -ENOTTY;
  }
}

long UsbFs::submit(UMockdevIoctlData* argument, emulator::Time pause) {
  UMockdevIoctlData* const data =
      umockdev_ioctl_data_resolve(argument, 0, sizeof(usbdevfs_urb), nullptr);
  Urb urb{umockdev_ioctl_data_ref(data)};
  umockdev_ioctl_data_resolve(data, G_STRUCT_OFFSET(usbdevfs_urb, buffer),
                              static_cast<gsize>(urb.urb().buffer_length), nullptr);
  const emulator::UsbAnswers::Id id = next_id_++;
  in_flight_.emplace(id, urb);
  const bool listens = urb.urb().endpoint == peripheral_.identity().in_endpoint;
  std::vector<emulator::UsbAnswers::Completed> completed;
  answers_.exchange(completed);
  if (!listens && answers_.nothing_to_send() && pause >= kPause) {
    const emulator::Time end = peripheral_.now() + pause;
    while (peripheral_.now() < end) answers_.pass(end, completed);
  }
  if (urb.urb().type == USBDEVFS_URB_TYPE_CONTROL) {
    completed.push_back(control(id, urb));
  } else if (listens) {
    answers_.submit_in(id);
  } else {
    answers_.submit_out(id, {urb.bytes(), urb.bytes() + urb.urb().buffer_length});
  }
  complete(completed);
  return 0;
}

emulator::UsbAnswers::Completed UsbFs::control(emulator::UsbAnswers::Id id, const Urb& urb) {
  const std::span bytes(urb.bytes(), static_cast<std::size_t>(urb.urb().buffer_length));
  emulator::UsbSetup setup{};
  std::copy_n(bytes.begin(), setup.size(), setup.begin());
  return answers_.control(id, setup, bytes.subspan(setup.size()));
}

long UsbFs::discard(UMockdevIoctlData* argument) {
  gulong client_address = 0;
  std::memcpy(&client_address, argument->data, sizeof client_address);
  for (const auto& [id, urb] : in_flight_) {
    if (urb.data->client_addr != client_address) continue;
    if (!answers_.discard(id)) break;
    complete(id, -ENOENT);
    return 0;
  }
  return -EINVAL;
}

long UsbFs::reap(UMockdevIoctlData* argument) {
  if (plugged_) {
    const emulator::Time end = peripheral_.now() + kStep;
    std::vector<emulator::UsbAnswers::Completed> completed;
    while (completed.empty() && complete_.empty() && !answers_.idle() && peripheral_.now() < end) {
      answers_.pass(end, completed);
    }
    complete(completed);
  }
  if (complete_.empty()) return plugged_ ? -EAGAIN : -ENODEV;
  UMockdevIoctlData* const out =
      umockdev_ioctl_data_resolve(argument, 0, sizeof(gpointer), nullptr);
  umockdev_ioctl_data_set_ptr(out, 0, complete_.front().data);
  umockdev_ioctl_data_unref(complete_.front().data);
  complete_.pop_front();
  return 0;
}

void UsbFs::complete(const std::vector<emulator::UsbAnswers::Completed>& completed) {
  for (const emulator::UsbAnswers::Completed& one : completed) {
    const Urb& urb = in_flight_.at(one.id);
    const bool control = urb.urb().type == USBDEVFS_URB_TYPE_CONTROL;
    const std::size_t offset = control ? emulator::kSetupBytes : 0;
    EXPECT_LE(offset + one.received.size(), static_cast<std::size_t>(urb.urb().buffer_length));
    std::copy(one.received.begin(), one.received.end(), urb.bytes() + offset);
    urb.urb().actual_length =
        static_cast<int>(one.received.empty() ? one.sent : one.received.size());
    complete(one.id, one.stalled ? -EPIPE : 0);
  }
}

void UsbFs::complete(emulator::UsbAnswers::Id id, int status) {
  const auto found = in_flight_.find(id);
  found->second.urb().status = status;
  complete_.push_back(found->second);
  in_flight_.erase(found);
}

}  // namespace imunoise::testing
