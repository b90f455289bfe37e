#pragma once

// The kernel's side of libusb: /dev/bus/usb with an emulated device in it, by umockdev.

#include <umockdev.h>

#include <chrono>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "drivers/emulator/usb/usb_peripheral.h"

struct usbdevfs_urb;

namespace imunoise::testing {

/// One device, plugged in from the start. It needs umockdev's library preloaded: see available().
/// Time passes for the device as fast as libusb asks for its data, so that a busy machine changes
/// nothing; where the driver had asked for nothing, paused and speaks again, the pause has passed
/// as well. Its calls come from a thread of umockdev: look at the device with lock() held.
class UsbFs {
 public:
  /// Borrows the peripheral.
  explicit UsbFs(emulator::UsbPeripheral& peripheral);
  UsbFs(const UsbFs&) = delete;
  UsbFs& operator=(const UsbFs&) = delete;
  ~UsbFs();

  static bool available();

  std::unique_lock<std::mutex> lock() { return std::unique_lock(mutex_); }
  void unplug();
  void plug();
  /// Another program has claimed the interface.
  void set_busy(bool busy);

 private:
  struct Unref {
    void operator()(gpointer object) const { g_object_unref(object); }
  };
  struct Urb {
    UMockdevIoctlData* data;  // ours until it is reaped
    std::size_t done = 0;     // bytes that the device took
    usbdevfs_urb& urb() const;
    unsigned char* bytes() const;
  };
  using Clock = std::chrono::steady_clock;

  static gboolean on_ioctl(UMockdevIoctlBase* base, UMockdevIoctlClient* client, UsbFs* self);
  /// The result of a call: not negative, or -errno.
  long serve(unsigned long request, UMockdevIoctlData* argument);
  long submit(UMockdevIoctlData* argument, emulator::Time pause);
  long discard(UMockdevIoctlData* argument);
  long reap(UMockdevIoctlData* argument);
  int control(unsigned char* setup, int length);
  void pass(emulator::Time end);
  void exchange_data();
  void complete(std::deque<Urb>& queue, int status);
  std::string node() const;
  std::string path() const;

  emulator::UsbPeripheral& peripheral_;
  std::mutex mutex_;
  bool plugged_ = false;
  bool busy_ = false;
  int number_ = 1;  // of the device on its bus; grows with every plug
  Clock::time_point last_call_ = Clock::now();
  std::deque<Urb> in_;
  std::deque<Urb> out_;
  std::deque<Urb> complete_;
  std::unique_ptr<UMockdevTestbed, Unref> testbed_;
  std::unique_ptr<UMockdevIoctlBase, Unref> ioctls_;
};

}  // namespace imunoise::testing
