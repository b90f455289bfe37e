#include "drivers/emulator/sensors/xsens_on_pty.h"

#include <algorithm>
#include <array>
#include <utility>

namespace imunoise::emulator {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kTick{2};  // how often the line is looked at

}  // namespace

XsensOnPty::XsensOnPty(MtiOptions options, SampleSource& source, std::vector<Fault> faults,
                       std::filesystem::path link, Memory memory)
    : link_(std::move(link)),
      faults_(std::move(faults)),
      device_(std::move(options), source),
      sent_(memory),
      line_(std::make_unique<Pty>(link_)),
      due_(Clock::now()),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

std::vector<SentMessage> XsensOnPty::sent() const {
  const std::lock_guard lock(mutex_);
  return sent_.items();
}

std::size_t XsensOnPty::messages() const {
  const std::lock_guard lock(mutex_);
  return sent_.size();
}

std::uint64_t XsensOnPty::writes() const {
  const std::lock_guard lock(mutex_);
  return device_.writes();
}

void XsensOnPty::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    talk_until(std::min(due_, Clock::now() + kTick));
    if (Clock::now() < due_) continue;
    const std::lock_guard lock(mutex_);
    if (!device_.measuring()) {
      due_ = Clock::now() + kTick;
      continue;
    }
    send_sample();
    due_ += std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(1.0 / device_.rate_hz()));
  }
}

void XsensOnPty::talk_until(Clock::time_point moment) {
  const auto left = std::chrono::ceil<milliseconds>(moment - Clock::now());
  if (!line_) return std::this_thread::sleep_until(moment);
  std::array<std::uint8_t, 256> bytes;
  const auto timeout = static_cast<int>(std::max<std::int64_t>(0, left.count()));
  const std::size_t count = line_->read(bytes, timeout);
  const std::lock_guard lock(mutex_);
  if (count == 0 || line_->host_baud() != device_.baud()) return;
  line_->write(device_.receive(drivers::Bytes(bytes).first(count)));
}

void XsensOnPty::send_sample() {
  if (!line_) {
    if (--unplugged_for_ > 0) return;
    device_.power_on();
    line_ = std::make_unique<Pty>(link_);
  }
  const bool ordered = device_.ordered();
  const auto fault = ordered ? faults_.at(sent_.size()) : std::nullopt;
  MtiMessage message = device_.measure();
  std::vector<std::uint8_t> frame = message.frame;
  const bool intact = !fault || pass(*fault, frame);
  if (!fault || fault->kind != Fault::Kind::kLate) {
    held_back_.insert(held_back_.end(), frame.begin(), frame.end());
    write(std::exchange(held_back_, {}));
  }
  if (ordered) sent_.push_back({std::move(message), intact});
}

// What the fault leaves of a frame. True where nothing is missing.
bool XsensOnPty::pass(const Fault& fault, std::vector<std::uint8_t>& frame) {
  switch (fault.kind) {
    case Fault::Kind::kBitError:
      frame[fault.at / 8 % frame.size()] ^= static_cast<std::uint8_t>(1U << fault.at % 8);
      return false;
    case Fault::Kind::kLoss: {
      const std::size_t from = std::min(fault.at, frame.size());
      const std::size_t count = std::min<std::size_t>(fault.count, frame.size() - from);
      const auto first = frame.begin() + static_cast<std::ptrdiff_t>(from);
      frame.erase(first, first + static_cast<std::ptrdiff_t>(count));
      return false;
    }
    case Fault::Kind::kUnplug:
      line_->drain();  // unread bytes of a cut line are lost, an unknown number of them
      line_.reset();
      unplugged_for_ = fault.count;
      [[fallthrough]];
    case Fault::Kind::kStall:
      frame.clear();
      return false;
    case Fault::Kind::kLate:
      break;
  }
  held_back_.insert(held_back_.end(), frame.begin(), frame.end());
  return true;
}

void XsensOnPty::write(drivers::Bytes bytes) const {
  if (!line_ || bytes.empty()) return;
  if (line_->host_baud() == device_.baud()) return line_->write(bytes);
  std::vector<std::uint8_t> noise(bytes.begin(), bytes.end());
  for (std::uint8_t& byte : noise) byte ^= 0x5aU;
  line_->write(noise);
}

}  // namespace imunoise::emulator
