#pragma once

// A device of the kernel's Industrial I/O subsystem that fills a buffer; the one file with libiio.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/iio/channels.h"

struct iio_buffer;
struct iio_channel;
struct iio_context;
struct iio_device;

namespace imunoise::iio {

struct Choice {
  std::string device;   ///< Name ("adis16475") or id ("iio:device0"); empty: the only IMU there is.
  std::string trigger;  ///< Its name; empty: the one that the device has.
  std::optional<double> rate_hz;
};

/// One sample: numbers in the order of channels(), and when the kernel took it (ns, its time of
/// day; 0: it does not say).
struct Scan {
  std::int64_t time_ns = 0;
  std::vector<std::int64_t> numbers;
};

/// Fills its buffer from construction on. One thread at a time. Throws plugin::DeviceError:
/// NOT_FOUND, BAD_OPTION, NO_ACCESS, DISCONNECTED.
class BufferedDevice {
 public:
  explicit BufferedDevice(const Choice& choice);

  /// The kernel's name: "gyro_3d"; its id where it has none.
  std::string name() const;
  /// What finds it again after it was unplugged, when its id may be another: its name, or its id
  /// where several IMUs have that name.
  std::string lasting_name() const;
  const std::vector<ScanChannel>& channels() const { return channels_; }
  /// 0: it does not say.
  double rate_hz() const { return rate_hz_; }
  /// Readable when samples are there; not when the device disappears: only take() tells.
  int descriptor() const { return descriptor_; }
  /// All that are there, perhaps none.
  std::vector<Scan> take();

 private:
  struct Close {
    void operator()(iio_context* context) const;
    void operator()(iio_buffer* buffer) const;
  };

  void find(const std::string& wanted);
  double attribute(const iio_channel* channel, const char* name, double otherwise) const;
  void choose_channels();
  void set_rate(const std::optional<double>& wanted);
  void set_trigger(const std::string& name);
  void start();
  std::int64_t number(const iio_channel* channel, const void* bytes) const;
  [[noreturn]] void fail(std::int32_t code, const std::string& what) const;

  std::unique_ptr<iio_context, Close> context_;
  iio_device* device_ = nullptr;
  std::vector<iio_channel*> scanned_;
  iio_channel* timestamp_ = nullptr;
  std::vector<ScanChannel> channels_;
  double rate_hz_ = 0.0;
  std::unique_ptr<iio_buffer, Close> buffer_;
  int descriptor_ = -1;
};

}  // namespace imunoise::iio
