#pragma once

// The kernel's side of libusb: /dev/bus/usb with an emulated device in it, by umockdev.

#include <umockdev.h>

#include <chrono>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "drivers/emulator/usb/usb_answers.h"

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
  /// The IN endpoint stalls until it is cleared.
  void halt_in();

 private:
  struct Unref {
    void operator()(gpointer object) const { g_object_unref(object); }
  };
  struct Urb {
    UMockdevIoctlData* data;  // ours until it is reaped
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
  emulator::UsbAnswers::Completed control(emulator::UsbAnswers::Id id, const Urb& urb);
  void complete(const std::vector<emulator::UsbAnswers::Completed>& completed);
  void complete(emulator::UsbAnswers::Id id, int status);
  std::string node() const;
  std::string path() const;

  emulator::UsbPeripheral& peripheral_;
  std::mutex mutex_;
  bool plugged_ = false;
  bool busy_ = false;
  int number_ = 1;  // of the device on its bus; grows with every plug
  Clock::time_point last_call_ = Clock::now();
  emulator::UsbAnswers answers_;
  emulator::UsbAnswers::Id next_id_ = 0;
  std::map<emulator::UsbAnswers::Id, Urb> in_flight_;
  std::deque<Urb> complete_;
  std::unique_ptr<UMockdevTestbed, Unref> testbed_;
  std::unique_ptr<UMockdevIoctlBase, Unref> ioctls_;
};

}  // namespace imunoise::testing
