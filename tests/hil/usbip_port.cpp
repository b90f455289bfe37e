#include "tests/hil/usbip_port.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <span>
#include <string>
#include <system_error>
#include <utility>

#include "drivers/codec/bytes.h"

namespace imunoise::testing {
namespace {

using namespace std::chrono_literals;
using emulator::UsbAnswers;

constexpr const char* kAttach = "/sys/devices/platform/vhci_hcd.0/attach";
constexpr auto kStep = 1ms;     // between two looks at the device
constexpr auto kReleased = 2s;  // the kernel releases a port some time after its cable is pulled

// Fields of a message, big-endian; both directions have the same length.
constexpr std::size_t kHeaderBytes = 48;
enum Command : std::uint32_t { kSubmit = 1, kUnlink = 2, kSubmitAnswer = 3, kUnlinkAnswer = 4 };
constexpr std::uint32_t kFromDevice = 1;
constexpr std::size_t kSetupAt = 40;
constexpr std::uint32_t kMostBytes = 1U << 20U;
enum Speed : unsigned { kFullSpeed = 2, kHighSpeed = 3 };

[[noreturn]] void throw_errno(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

bool read_all(int socket, std::span<std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::read(socket, bytes.data(), bytes.size());
    if (count <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return true;
}

bool write_all(int socket, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return true;
}

bool readable(int socket, std::chrono::milliseconds wait) {
  pollfd polled{socket, POLLIN, 0};
  return ::poll(&polled, 1, static_cast<int>(wait.count())) > 0;
}

// Hands the other end of a new socket pair to the kernel; ours is returned.
int attach(unsigned port, const emulator::UsbIdentity& identity) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw_errno("socket pair");
  }
  const bool high = identity.packet_bytes > 64;
  const std::string text = fmt::format("{} {} {} {}", port, ends[1], 0x10000U + port + 1,
                                       high ? kHighSpeed : kFullSpeed);
  const int file = ::open(kAttach, O_WRONLY | O_CLOEXEC);
  const auto write = [&] {
    return ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  };
  bool done = file >= 0 && write();
  for (const auto end = std::chrono::steady_clock::now() + kReleased;
       !done && errno == EBUSY && std::chrono::steady_clock::now() < end;) {
    std::this_thread::sleep_for(10ms);
    done = write();
  }
  const int error = errno;
  if (file >= 0) ::close(file);
  ::close(ends[1]);
  if (done) return ends[0];
  ::close(ends[0]);
  errno = error;
  throw_errno(
      fmt::format("{}: port {} (modprobe vhci_hcd; only root may write there)", kAttach, port));
}

}  // namespace

UsbIpPort::UsbIpPort(emulator::UsbPeripheral& peripheral, unsigned port)
    : peripheral_(peripheral), port_(port), answers_(peripheral) {
  plug();
}

UsbIpPort::~UsbIpPort() { unplug(); }

void UsbIpPort::plug() {
  unplug();
  const int socket = attach(port_, peripheral_.identity());
  {
    const auto held = lock();
    peripheral_.power_up();
    plugged_ = Clock::now();
  }
  thread_ = std::jthread([this, socket](const std::stop_token& stop) {
    serve(socket, stop);
    ::close(socket);
  });
}

void UsbIpPort::unplug() {
  thread_ = {};
  answers_.discard_all();
  to_send_.clear();
}

void UsbIpPort::hold_up(emulator::Time duration) {
  const auto held = lock();
  held_until_ = Clock::now() + duration;
}

void UsbIpPort::halt_in() {
  const auto held = lock();
  answers_.halt_in();
}

void UsbIpPort::lose_byte() {
  const auto held = lock();
  answers_.lose_byte();
}

std::uint64_t UsbIpPort::transfers() {
  const auto held = lock();
  return transfers_;
}

void UsbIpPort::serve(int socket, const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    const bool speaks = readable(socket, kStep);
    const auto held = lock();
    if (speaks && !take_messages(socket)) return;
    let_time_pass();
    if (!send_answers(socket)) return;
  }
}

bool UsbIpPort::take_messages(int socket) {
  do {
    if (!take_message(socket)) return false;
  } while (readable(socket, 0ms));
  return true;
}

bool UsbIpPort::take_message(int socket) {
  std::array<std::uint8_t, kHeaderBytes> header{};
  if (!read_all(socket, header)) return false;
  drivers::BigEndianReader reader(header);
  const auto next = [&] { return reader.take<std::uint32_t>(); };
  const std::uint32_t command = next();
  const std::uint32_t sequence = next();
  next();  // device
  const bool to_host = next() == kFromDevice;
  const std::uint32_t endpoint = next();
  const std::uint32_t first = next();
  if (command == kUnlink) {
    const bool was_here = answers_.discard(first);
    to_send_.push_back({sequence, true, was_here ? -ECONNRESET : 0, 0, {}});
    return true;
  }
  const std::uint32_t length = next();
  if (command != kSubmit || length > kMostBytes) return false;
  std::vector<std::uint8_t> bytes(to_host ? 0 : length);
  if (!read_all(socket, bytes)) return false;
  ++transfers_;
  if (endpoint == 0) {
    emulator::UsbSetup setup{};
    std::copy_n(header.begin() + kSetupAt, setup.size(), setup.begin());
    answer(answers_.control(sequence, setup, bytes));
  } else if (to_host) {
    answers_.submit_in(sequence);
  } else {
    answers_.submit_out(sequence, std::move(bytes));
  }
  return true;
}

void UsbIpPort::let_time_pass() {
  const emulator::Time end = Clock::now() - plugged_;
  std::vector<UsbAnswers::Completed> completed;
  answers_.exchange(completed);
  while (peripheral_.now() < end) answers_.pass(end, completed);
  for (UsbAnswers::Completed& one : completed) answer(std::move(one));
}

void UsbIpPort::answer(UsbAnswers::Completed completed) {
  to_send_.push_back({static_cast<std::uint32_t>(completed.id), false,
                      completed.stalled ? -EPIPE : 0,
                      completed.received.empty() ? completed.sent : completed.received.size(),
                      std::move(completed.received)});
}

bool UsbIpPort::send_answers(int socket) {
  if (Clock::now() < held_until_) return true;
  std::vector<std::uint8_t> out;
  for (const Answer& one : std::exchange(to_send_, {})) {
    const std::size_t end = out.size() + kHeaderBytes;
    drivers::append_big_endian(
        out, one.unlink ? std::uint32_t{kUnlinkAnswer} : std::uint32_t{kSubmitAnswer});
    drivers::append_big_endian(out, one.sequence);
    for (int i = 0; i < 3; ++i) drivers::append_big_endian(out, std::uint32_t{0});
    drivers::append_big_endian(out, static_cast<std::uint32_t>(one.status));
    drivers::append_big_endian(out, static_cast<std::uint32_t>(one.actual));
    out.resize(end);
    out.insert(out.end(), one.bytes.begin(), one.bytes.end());
  }
  return write_all(socket, out);
}

}  // namespace imunoise::testing
