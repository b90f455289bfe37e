#include "drivers/iio/buffered_device.h"

#include <fmt/format.h>
#include <iio.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <string_view>
#include <system_error>

#include "drivers/plugin/device.h"

namespace imunoise::iio {
namespace {

using plugin::DeviceError;

constexpr double kBlockTime = 0.05;  // s of samples that wake the reader once
constexpr double kMostInBlock = 1024.0;
constexpr double kQueueTime = 5.0;  // s of samples that wait in the kernel for a busy machine
constexpr double kLeastInQueue = 512.0;
constexpr const char* kRateAttribute = "sampling_frequency";
constexpr const char* kTimestamp = "timestamp";

std::string text(const char* maybe) { return maybe == nullptr ? "" : maybe; }

std::string describe(const iio_device* device) {
  return fmt::format("{} ({})", text(iio_device_get_name(device)), iio_device_get_id(device));
}

template <class Visitor>
void for_each_scanned(const iio_device* device, Visitor&& visitor) {
  for (unsigned i = 0; i < iio_device_get_channels_count(device); ++i) {
    iio_channel* const channel = iio_device_get_channel(device, i);
    if (iio_channel_is_scan_element(channel) && !iio_channel_is_output(channel)) visitor(channel);
  }
}

bool is_imu(const iio_device* device) {
  bool out = false;
  for_each_scanned(device, [&](const iio_channel* channel) {
    out = out || is_inertial(iio_channel_get_id(channel));
  });
  return out;
}

std::string meaning(int error) { return std::generic_category().message(error); }

}  // namespace

void BufferedDevice::Close::operator()(iio_context* context) const { iio_context_destroy(context); }
void BufferedDevice::Close::operator()(iio_buffer* buffer) const { iio_buffer_destroy(buffer); }

BufferedDevice::BufferedDevice(const Choice& choice) : context_(iio_create_local_context()) {
  if (!context_) {
    throw DeviceError(IMUNOISE_NOT_FOUND,
                      "this kernel shows no IIO device; is the IMU's kernel driver loaded (ls "
                      "/sys/bus/iio/devices)?");
  }
  find(choice.device);
  choose_channels();
  set_trigger(choice.trigger);
  set_rate(choice.rate_hz);
  start();
}

std::string BufferedDevice::name() const {
  const char* const name = iio_device_get_name(device_);
  return text(name == nullptr ? iio_device_get_id(device_) : name);
}

std::string BufferedDevice::lasting_name() const {
  int same = 0;
  for (unsigned i = 0; i < iio_context_get_devices_count(context_.get()); ++i) {
    const iio_device* const one = iio_context_get_device(context_.get(), i);
    same += is_imu(one) && text(iio_device_get_name(one)) == name() ? 1 : 0;
  }
  return same == 1 ? name() : iio_device_get_id(device_);
}

void BufferedDevice::fail(std::int32_t code, const std::string& what) const {
  throw DeviceError(code, fmt::format("IIO {}: {}", describe(device_), what));
}

void BufferedDevice::find(const std::string& wanted) {
  std::string there;
  std::vector<iio_device*> found;
  for (unsigned i = 0; i < iio_context_get_devices_count(context_.get()); ++i) {
    iio_device* const device = iio_context_get_device(context_.get(), i);
    if (!is_imu(device)) continue;
    there += (there.empty() ? "" : ", ") + describe(device);
    if (wanted.empty() || wanted == text(iio_device_get_name(device)) ||
        wanted == iio_device_get_id(device)) {
      found.push_back(device);
    }
  }
  if (found.size() > 1) {
    throw DeviceError(
        IMUNOISE_BAD_OPTION,
        "IIO: several IMUs: choose one by device=NAME or device=iio:deviceN: " + there);
  }
  if (found.empty()) {
    throw DeviceError(
        IMUNOISE_NOT_FOUND,
        fmt::format("IIO: no IMU{}{} with a buffer; there are: {}", wanted.empty() ? "" : " ",
                    wanted, there.empty() ? "none" : there));
  }
  device_ = found.front();
}

double BufferedDevice::attribute(const iio_channel* channel, const char* name,
                                 double otherwise) const {
  if (iio_channel_find_attr(channel, name) == nullptr) return otherwise;
  double out = otherwise;
  const int error = iio_channel_attr_read_double(channel, name, &out);
  if (error < 0)
    fail(IMUNOISE_FAILED, fmt::format("{} of {} cannot be read: {}", name,
                                      iio_channel_get_id(channel), meaning(-error)));
  return out;
}

void BufferedDevice::choose_channels() {
  for_each_scanned(device_, [&](iio_channel* channel) {
    const std::string_view id = iio_channel_get_id(channel);
    const iio_data_format& format = *iio_channel_get_data_format(channel);
    if (id == kTimestamp) {
      timestamp_ = channel;
    } else if (format.repeat <= 1 && format.length <= 64) {
      scanned_.push_back(channel);
      channels_.push_back({std::string(id), attribute(channel, "scale", 1.0),
                           attribute(channel, "offset", 0.0), format.bits, format.is_signed});
    } else {
      return;  // a quaternion, or wider than any number
    }
    iio_channel_enable(channel);
  });
}

void BufferedDevice::set_trigger(const std::string& name) {
  if (name.empty()) return;
  const iio_device* const trigger = iio_context_find_device(context_.get(), name.c_str());
  if (trigger == nullptr || !iio_device_is_trigger(trigger)) {
    fail(IMUNOISE_BAD_OPTION,
         "no trigger " + name + "; see: cat /sys/bus/iio/devices/trigger*/name");
  }
  const int error = iio_device_set_trigger(device_, trigger);
  if (error < 0) fail(IMUNOISE_BAD_OPTION, fmt::format("trigger {}: {}", name, meaning(-error)));
}

// The rate is an attribute of the device, or of its channels. It is left alone where it is right:
// of some devices it cannot be written.
void BufferedDevice::set_rate(const std::optional<double>& wanted) {
  const bool of_device = iio_device_find_attr(device_, kRateAttribute) != nullptr;
  const auto with_rate =
      std::find_if(scanned_.begin(), scanned_.end(), [](const iio_channel* channel) {
        return iio_channel_find_attr(channel, kRateAttribute) != nullptr;
      });
  const bool known = of_device || with_rate != scanned_.end();
  if (!known && wanted)
    fail(IMUNOISE_BAD_OPTION, "its rate cannot be set; it is that of its trigger");
  if (!known) return;
  const auto read = [&] {
    const int error = of_device
                          ? iio_device_attr_read_double(device_, kRateAttribute, &rate_hz_)
                          : iio_channel_attr_read_double(*with_rate, kRateAttribute, &rate_hz_);
    if (error < 0) rate_hz_ = 0.0;
  };
  read();
  if (!wanted || rate_hz_ == *wanted) return;
  const int error = of_device ? iio_device_attr_write_double(device_, kRateAttribute, *wanted)
                              : iio_channel_attr_write_double(*with_rate, kRateAttribute, *wanted);
  if (error < 0) {
    fail(error == -EACCES ? IMUNOISE_NO_ACCESS : IMUNOISE_BAD_OPTION,
         fmt::format("rate {:g} Hz: {}; see its attribute sampling_frequency_available", *wanted,
                     meaning(-error)));
  }
  read();
}

void BufferedDevice::start() {
  const double block = std::clamp(std::floor(rate_hz_ * kBlockTime), 1.0, kMostInBlock);
  const double queue = std::max(kLeastInQueue, rate_hz_ * kQueueTime);
  iio_device_set_kernel_buffers_count(device_, static_cast<unsigned>(std::ceil(queue / block)));
  buffer_.reset(iio_device_create_buffer(device_, static_cast<std::size_t>(block), false));
  if (!buffer_) {
    const int error = errno;
    const bool access = error == EACCES || error == EPERM || error == EROFS;
    fail(access           ? IMUNOISE_NO_ACCESS
         : error == EBUSY ? IMUNOISE_NO_ACCESS
                          : IMUNOISE_FAILED,
         fmt::format("its buffer does not start ({}); {}", meaning(error),
                     access           ? "docs/iio.md says how to give access"
                     : error == EBUSY ? "end the other program that reads it"
                                      : "does it need a trigger (trigger=NAME)?"));
  }
  iio_buffer_set_blocking_mode(buffer_.get(), false);
  descriptor_ = iio_buffer_get_poll_fd(buffer_.get());
  if (descriptor_ < 0)
    fail(IMUNOISE_FAILED, "its buffer cannot be waited for: " + meaning(-descriptor_));
}

std::vector<Scan> BufferedDevice::take() {
  const ssize_t count = iio_buffer_refill(buffer_.get());
  if (count == -EAGAIN || count == -EINTR) return {};
  if (count < 0)
    fail(IMUNOISE_DISCONNECTED, meaning(static_cast<int>(-count)) + "; plug it in again");
  std::vector<Scan> out;
  const std::ptrdiff_t step = iio_buffer_step(buffer_.get());
  const auto* const begin =
      static_cast<const char*>(iio_buffer_first(buffer_.get(), scanned_.front()));
  const auto* const end = static_cast<const char*>(iio_buffer_end(buffer_.get()));
  const auto place = [&](const iio_channel* channel, std::ptrdiff_t offset) {
    return static_cast<const char*>(iio_buffer_first(buffer_.get(), channel)) + offset;
  };
  for (const char* scan = begin; scan < end; scan += step) {
    Scan& one = out.emplace_back();
    if (timestamp_ != nullptr) one.time_ns = number(timestamp_, place(timestamp_, scan - begin));
    for (const iio_channel* const channel : scanned_) {
      one.numbers.push_back(number(channel, place(channel, scan - begin)));
    }
  }
  return out;
}

// libiio turns bytes and shifts bits, and extends the sign within the length of the channel.
std::int64_t BufferedDevice::number(const iio_channel* channel, const void* bytes) const {
  const iio_data_format& format = *iio_channel_get_data_format(channel);
  std::array<unsigned char, 8> converted{};
  iio_channel_convert(channel, converted.data(), bytes);
  std::int64_t out = 0;
  std::memcpy(&out, converted.data(), format.length / 8);
  const unsigned unused = 64 - format.length;
  return format.is_signed ? out << unused >> unused : out;
}

}  // namespace imunoise::iio
