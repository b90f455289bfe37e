#pragma once

// What a driver implements.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>

#include "drivers/description.h"
#include "drivers/plugin/samples.h"
#include "drivers/plugin/wait.h"

namespace imunoise::plugin {

/// What goes wrong with a device; the host gets it as code and text. Other exceptions reach it as
/// IMUNOISE_FAILED.
class DeviceError : public std::runtime_error {
 public:
  /// `code` is IMUNOISE_NOT_FOUND or another of driver.h's; `text` names the thing, the place and
  /// the way out.
  DeviceError(std::int32_t code, const std::string& text) : std::runtime_error(text), code_(code) {}
  std::int32_t code() const { return code_; }

 private:
  std::int32_t code_;
};

/// Takes bytes as they came over a wire.
using WireTap = std::function<void(std::span<const std::uint8_t> bytes)>;

/// What the host does for a device. Copies are cheap. Thread-safe.
class Host {
 public:
  Host(const imunoise_host* table, void* context) : table_(table), context_(context) {}

  /// Set once the device being opened is no longer wanted: waits of its constructor go
  /// through Wait(host.opening(), ...), and end in a DeviceError of IMUNOISE_CANCELLED.
  const CancelSignal& opening() const { return *opening_; }
  /// The host's clock: ns since 1970-01-01 UTC. It never steps, even when the time of day is set.
  std::int64_t now_ns() const { return table_->now_ns(); }
  /// Tells what a person should know of the device: "reset after 3 bad checksums".
  void note(const std::string& text) const { table_->note(context_, text.c_str()); }
  /// Where to put the bytes that come over the device's wire, in the form of its captures; empty
  /// if they are not wanted. Ask once: at the device's opening.
  WireTap wire_tap() const {
    constexpr std::size_t kNeeded = offsetof(imunoise_host, wire) + sizeof(imunoise_host::wire);
    if (table_->size < kNeeded || table_->wire(context_, nullptr, 0) == 0) return {};
    return [table = table_, context = context_](std::span<const std::uint8_t> bytes) {
      table->wire(context, bytes.data(), bytes.size());
    };
  }

 private:
  friend class Opening;
  const imunoise_host* table_;
  void* context_;
  std::shared_ptr<CancelSignal> opening_ = std::make_shared<CancelSignal>();
};

/// While it lives, the host may end the opening.
class Opening {
 public:
  explicit Opening(const Host& host) : host_(host) {
    watch([](void* signal) { static_cast<CancelSignal*>(signal)->set(); });
  }
  Opening(const Opening&) = delete;
  Opening& operator=(const Opening&) = delete;
  ~Opening() { watch(nullptr); }

 private:
  void watch(void (*cancel)(void*)) const {
    constexpr std::size_t kNeeded =
        offsetof(imunoise_host, while_opening) + sizeof(imunoise_host::while_opening);
    if (host_.table_->size < kNeeded) return;
    host_.table_->while_opening(host_.context_, cancel, host_.opening_.get());
  }

  const Host host_;
};

/// An open device. The base calls one function at a time, from one thread at a time, except
/// interrupt(). The constructor starts the device and the destructor stops it; both, and read(),
/// may throw DeviceError.
class Device {
 public:
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  virtual ~Device() = default;

  /// What it is and what it delivers. Called once, right after construction.
  virtual drivers::DeviceInfo describe() = 0;

  /// Waits for samples and adds them, of any stream; returns when some have come, or sooner: it is
  /// called again until there are some or `wait` is over. Every wait goes through `wait`, or looks
  /// at wait.over() ten times a second. What was added before a throw is delivered before the
  /// error.
  virtual void read(Samples& samples, const Wait& wait) = 0;

  /// For a read that waits neither through `wait` nor looks at it: wakes it. From any thread, also
  /// while nothing is being read.
  virtual void interrupt() noexcept {}
};

}  // namespace imunoise::plugin
