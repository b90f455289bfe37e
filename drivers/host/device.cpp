#include "drivers/host/device.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <utility>

#include "core/support/utf8.h"
#include "drivers/host/check.h"

namespace imunoise::drivers {
namespace {

// Room for what a driver says of an error.
class ErrorText {
 public:
  imunoise_error* table() { return &table_; }
  // What was cut to fit may end within a character.
  std::string text() {
    text_.back() = '\0';  // whatever the driver did to it
    return repaired_utf8(text_.data());
  }

 private:
  std::array<char, 1024> text_ = {};
  imunoise_error table_ = {sizeof(imunoise_error), static_cast<std::uint32_t>(text_.size()),
                           text_.data()};
};

constexpr std::int32_t kThrew = INT32_MIN;

// Calls into a plugin; kThrew where it threw an exception.
template <class Call>
std::int32_t guarded(Call&& call) noexcept {
  try {
    return call();
  } catch (...) {
    return kThrew;
  }
}

std::string_view meaning(std::int32_t status) {
  switch (status) {
    case IMUNOISE_FAILED:
      return "failed";
    case IMUNOISE_BAD_OPTION:
      return "an option has a value that this device cannot do";
    case IMUNOISE_NOT_FOUND:
      return "no such device";
    case IMUNOISE_NO_ACCESS:
      return "no permission, or in use by another program";
    case IMUNOISE_BAD_DEVICE:
      return "the device does not answer as it should";
    case IMUNOISE_DISCONNECTED:
      return "the device is disconnected";
    case kThrew:
      return "the driver threw an exception";
    default:
      return "unknown error";
  }
}

std::string failure(const Driver& driver, std::int32_t status, std::string_view text) {
  return fmt::format("driver {}: {}", driver.info.name, text.empty() ? meaning(status) : text);
}

template <class Number>
bool all_finite(std::span<const Number> numbers) {
  return std::all_of(numbers.begin(), numbers.end(), [](Number x) { return std::isfinite(x); });
}

}  // namespace

Device::Device(Driver driver, NoteHandler note, WireHandler wire, std::stop_token stop)
    : driver_(std::move(driver)), handlers_{std::move(note), std::move(wire), std::move(stop)} {}

Device::~Device() {
  if (handle_ == nullptr) return;
  guarded([&] {
    driver_.table->close(handle_);
    return IMUNOISE_OK;
  });
}

Result<std::unique_ptr<Device>> Device::open(const Driver& driver,
                                             std::span<const OptionText> options, NoteHandler note,
                                             WireHandler wire, std::stop_token stop) {
  const Result<OptionValues> values = OptionValues::make(driver.info.options, options);
  if (!values) return fail(failure(driver, IMUNOISE_BAD_OPTION, values.error().message));
  std::unique_ptr<Device> device(
      new Device(driver, std::move(note), std::move(wire), std::move(stop)));
  const Result<void> started = device->start(*values);
  if (!started) return tl::make_unexpected(started.error());
  return device;
}

Result<void> Device::start(const OptionValues& values) {
  ErrorText error;
  imunoise_device* handle = nullptr;
  std::int32_t status = guarded([&] {
    return driver_.table->open(values.data(), values.size(), &handlers_, &handle, error.table());
  });
  handlers_.stopping.reset();  // also where the driver forgot to take it back
  if (status == IMUNOISE_OK && handle == nullptr) {
    return fail(failure(driver_, status, "open succeeded without a device"));
  }
  if (status != IMUNOISE_OK) return fail(failure(driver_, status, error.text()));
  handle_ = handle;
  const imunoise_device_info* table = nullptr;
  status = guarded([&] { return driver_.table->describe(handle_, &table, error.table()); });
  if (status != IMUNOISE_OK) return fail(failure(driver_, status, error.text()));
  Result<DeviceInfo> info = check_device(table);
  if (!info) {
    return fail(failure(driver_, status,
                        fmt::format("{} ({})", info.error().message, driver_.file.string())));
  }
  info_ = std::make_shared<const DeviceInfo>(std::move(*info));
  return {};
}

Result<ReadOutcome> Device::read(std::chrono::milliseconds timeout, SampleBlock& block) {
  assert(block.device_ == info_ && "the block was made for another device");
  if (broken_) return tl::make_unexpected(*broken_);
  ErrorText error;
  imunoise_block& table = block.prepare();
  const auto most = std::clamp<std::int64_t>(timeout.count(), 0, INT32_MAX);
  const std::int32_t status = guarded([&] {
    return driver_.table->read(handle_, static_cast<std::int32_t>(most), &table, error.table());
  });
  return outcome(status, block, error.text());
}

Result<ReadOutcome> Device::outcome(std::int32_t status, const SampleBlock& block,
                                    std::string_view text) {
  const auto broken = [&](std::string_view what) {
    broken_ =
        Error{fmt::format("driver {}: {}; it breaks the rules of driver.h and is not called "
                          "again; report this to the author of {}",
                          driver_.info.name, what, driver_.file.string())};
    block.table_->rows = 0;
    block.table_->stream = 0;
    return tl::make_unexpected(*broken_);
  };
  if (status == kThrew) return broken("read threw an exception");
  if (status == IMUNOISE_OK) {
    const Result<void> sound = check_samples(block);
    if (!sound) return broken(sound.error().message);
    return ReadOutcome::kSamples;
  }
  if (block.rows() > 0 || block.any_refused()) {
    return broken(fmt::format("read delivered samples and returned {}", status));
  }
  switch (status) {
    case IMUNOISE_TIMEOUT:
      return ReadOutcome::kTimeout;
    case IMUNOISE_CANCELLED:
      return ReadOutcome::kCancelled;
    case IMUNOISE_END:
      return ReadOutcome::kEnd;
    case IMUNOISE_DISCONNECTED:
      disconnection_ = failure(driver_, status, text);
      return ReadOutcome::kDisconnected;
    default:
      if (status > 0)
        return broken(fmt::format("read returned {}, which is not a valid status", status));
      return fail(failure(driver_, status, text));
  }
}

Result<void> Device::check_samples(const SampleBlock& block) const {
  const imunoise_block& table = *block.table_;
  if (table.stream >= info_->streams.size()) {
    return fail(fmt::format("read delivered stream {} of {}", table.stream, info_->streams.size()));
  }
  const Stream& stream = block.stream();
  if (table.rows > table.row_capacity) {
    return fail(fmt::format("read delivered {} samples of stream {} where {} fit", table.rows,
                            stream.name, table.row_capacity));
  }
  if (table.rows == 0 && !block.any_refused()) {
    return fail("read returned without samples, rejections or another reason");
  }
  if (stream.counter_maximum > 0) {
    for (const std::uint64_t counter : block.counter()) {
      if (counter > stream.counter_maximum) {
        return fail(fmt::format("stream {}: counter {} is beyond its maximum {}", stream.name,
                                counter, stream.counter_maximum));
      }
    }
  }
  for (std::size_t c = 0; c < stream.channels.size(); ++c) {
    const bool finite = with_number_type(stream.channels[c].type, [&](auto number) {
      if constexpr (std::is_floating_point_v<decltype(number)>) {
        return all_finite(block.column<decltype(number)>(c));
      }
      return true;
    });
    if (!finite) {
      return fail(
          fmt::format("stream {}: channel {}: a number is not finite; such samples must "
                      "be rejected",
                      stream.name, stream.channels[c].name));
    }
  }
  return {};
}

void Device::cancel() noexcept {
  guarded([&] {
    driver_.table->cancel(handle_);
    return IMUNOISE_OK;
  });
}

}  // namespace imunoise::drivers
