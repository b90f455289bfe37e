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

constexpr emulator::Time kStep = 2ms;       // that passes where nothing can be reaped
constexpr emulator::Time kPause = 20ms;     // from here on an idle driver paused on purpose
constexpr std::size_t kSetupBytes = 8;      // of a control transfer
constexpr unsigned char kSerialString = 3;  // index of the string descriptor

using ByteVector = std::vector<std::uint8_t>;

void append_little_endian(ByteVector& out, unsigned value) {
  out.push_back(static_cast<std::uint8_t>(value & 0xffU));
  out.push_back(static_cast<std::uint8_t>(value >> 8U));
}

// Device, configuration, one interface, two bulk endpoints (USB 2.0 specification, chapter 9).
ByteVector descriptors(const emulator::UsbIdentity& identity) {
  ByteVector out = {18, 1, 0x00, 0x02, 0, 0, 0, 64};
  append_little_endian(out, identity.id.vendor);
  append_little_endian(out, identity.id.product);
  append_little_endian(out, 0x0900);
  out.insert(out.end(), {1, 2, kSerialString, 1});
  out.insert(out.end(), {9, 2, 32, 0, 1, 1, 0, 0x80, 50});
  out.insert(out.end(), {9, 4, 0, 0, 2, 0xff, 0xff, 0xff, 0});
  for (const std::uint8_t endpoint : {identity.in_endpoint, identity.out_endpoint}) {
    out.insert(out.end(), {7, 5, endpoint, 2});
    append_little_endian(out, identity.packet_bytes);
    out.push_back(0);
  }
  return out;
}

ByteVector string_descriptor(const std::string& text) {
  ByteVector out = {static_cast<std::uint8_t>(2 + 2 * text.size()), 3};
  for (const char letter : text) append_little_endian(out, static_cast<unsigned char>(letter));
  return out;
}

}  // namespace

usbdevfs_urb& UsbFs::Urb::urb() const {
  return *static_cast<usbdevfs_urb*>(static_cast<void*>(data->data));
}
unsigned char* UsbFs::Urb::bytes() const { return static_cast<unsigned char*>(urb().buffer); }

UsbFs::UsbFs(emulator::UsbPeripheral& peripheral)
    : peripheral_(peripheral),
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
  std::string hex;
  for (const std::uint8_t byte : descriptors(peripheral_.identity())) {
    hex += fmt::format("{:02X}", byte);
  }
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
    while (!in_.empty()) complete(in_, -ESHUTDOWN);
    while (!out_.empty()) complete(out_, -ESHUTDOWN);
  }
  umockdev_testbed_uevent(testbed_.get(), path().c_str(), "remove");
  umockdev_testbed_remove_device(testbed_.get(), path().c_str());
  umockdev_testbed_detach_ioctl(testbed_.get(), ("/dev/" + node()).c_str(), nullptr);
}

void UsbFs::set_busy(bool busy) {
  const auto held = lock();
  busy_ = busy;
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
  const bool listens = urb.urb().endpoint == peripheral_.identity().in_endpoint;
  exchange_data();
  if (!listens && out_.empty() && pause >= kPause) {
    const emulator::Time end = peripheral_.now() + pause;
    while (peripheral_.now() < end) pass(end);
  }
  if (urb.urb().type == USBDEVFS_URB_TYPE_CONTROL) {
    std::deque<Urb> now = {urb};
    const int result = control(urb.bytes(), urb.urb().buffer_length);
    urb.urb().actual_length = std::max(0, result);
    complete(now, std::min(0, result));
  } else {
    (listens ? in_ : out_).push_back(urb);
  }
  return 0;
}

// Bytes that were transferred, or -errno.
int UsbFs::control(unsigned char* setup, int length) {
  const unsigned value = setup[2] | setup[3] * 256U;
  const unsigned index = setup[4] | setup[5] * 256U;
  const std::span data(setup + kSetupBytes, static_cast<std::size_t>(length) - kSetupBytes);
  if (setup[0] == 0x80 && setup[1] == 6 && value >> 8U == 3) {  // a string
    const bool languages = (value & 0xffU) == 0;
    const ByteVector text =
        languages ? ByteVector{4, 3, 0x09, 0x04} : string_descriptor(peripheral_.identity().serial);
    const std::size_t count = std::min(text.size(), data.size());
    std::copy_n(text.begin(), count, data.begin());
    return static_cast<int>(count);
  }
  const bool accepted = setup[0] == 0x40 && peripheral_.control({setup[1],
                                                                 static_cast<std::uint16_t>(value),
                                                                 static_cast<std::uint16_t>(index),
                                                                 {data.begin(), data.end()}});
  return accepted ? static_cast<int>(data.size()) : -EPIPE;
}

long UsbFs::discard(UMockdevIoctlData* argument) {
  gulong client_address = 0;
  std::memcpy(&client_address, argument->data, sizeof client_address);
  for (std::deque<Urb>* const queue : {&in_, &out_}) {
    const auto found = std::find_if(queue->begin(), queue->end(), [&](const Urb& urb) {
      return urb.data->client_addr == client_address;
    });
    if (found == queue->end()) continue;
    std::deque<Urb> discarded = {*found};
    queue->erase(found);
    complete(discarded, -ENOENT);
    return 0;
  }
  return -EINVAL;
}

long UsbFs::reap(UMockdevIoctlData* argument) {
  if (plugged_) {
    const emulator::Time end = peripheral_.now() + kStep;
    while (complete_.empty() && !(in_.empty() && out_.empty()) && peripheral_.now() < end) {
      pass(end);
    }
  }
  if (complete_.empty()) return plugged_ ? -EAGAIN : -ENODEV;
  UMockdevIoctlData* const out =
      umockdev_ioctl_data_resolve(argument, 0, sizeof(gpointer), nullptr);
  umockdev_ioctl_data_set_ptr(out, 0, complete_.front().data);
  umockdev_ioctl_data_unref(complete_.front().data);
  complete_.pop_front();
  return 0;
}

// One thing of the device, and what it means for the transfers.
void UsbFs::pass(emulator::Time end) {
  exchange_data();
  peripheral_.run(end);
  exchange_data();
}

void UsbFs::exchange_data() {
  while (!out_.empty()) {
    Urb& urb = out_.front();
    const std::span bytes(urb.bytes(), static_cast<std::size_t>(urb.urb().buffer_length));
    urb.done += peripheral_.out(bytes.subspan(urb.done));
    if (urb.done < bytes.size()) break;
    urb.urb().actual_length = urb.urb().buffer_length;
    complete(out_, 0);
  }
  if (in_.empty()) return;
  if (const auto packet = peripheral_.in()) {
    const usbdevfs_urb& urb = in_.front().urb();
    EXPECT_LE(packet->size(), static_cast<std::size_t>(urb.buffer_length));
    std::copy(packet->begin(), packet->end(), in_.front().bytes());
    in_.front().urb().actual_length = static_cast<int>(packet->size());
    complete(in_, 0);
  }
}

void UsbFs::complete(std::deque<Urb>& queue, int status) {
  queue.front().urb().status = status;
  complete_.push_back(queue.front());
  queue.pop_front();
}

}  // namespace imunoise::testing
