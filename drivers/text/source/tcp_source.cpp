#include <fmt/format.h>
#include <netdb.h>
#include <sys/socket.h>

#include <string_view>

#include "drivers/plugin/device.h"
#include "drivers/text/source/descriptor.h"
#include "drivers/text/source/source.h"

namespace imunoise::text {
namespace {

struct Address {
  std::string host;
  std::string port;
};

Address address_of(std::string_view text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos || colon == 0 || colon + 1 == text.size())
    throw plugin::DeviceError(
        IMUNOISE_BAD_OPTION,
        fmt::format("tcp: '{}' is no HOST:PORT, such as 192.168.1.20:5000", text));
  std::string_view host = text.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  return {std::string(host), std::string(text.substr(colon + 1))};
}

class TcpSource final : public Source {
 public:
  TcpSource(std::string name, const Address& address, const plugin::Wait& wait)
      : name_(std::move(name)) {
    addrinfo hints{};
    hints.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    const int problem = ::getaddrinfo(address.host.c_str(), address.port.c_str(), &hints, &found);
    if (problem != 0) fail(IMUNOISE_NOT_FOUND, ::gai_strerror(problem));
    const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> all(found, &::freeaddrinfo);
    int error = ETIMEDOUT;
    for (const addrinfo* one = found; one != nullptr && error != 0; one = one->ai_next)
      error = connect_to(*one, wait);
    if (error != 0) fail(IMUNOISE_NOT_FOUND, std::generic_category().message(error));
  }
  int descriptor() const override { return socket_.number(); }
  std::optional<std::size_t> read(std::span<std::uint8_t> into) override {
    std::optional<std::size_t> got;
    try {
      got = socket_.read(into);
    } catch (const std::system_error& error) {
      fail(IMUNOISE_DISCONNECTED, error.code().message());
    }
    if (!got) fail(IMUNOISE_DISCONNECTED, "the other end closed the connection");
    return got;
  }

 private:
  // 0, or what errno would say.
  int connect_to(const addrinfo& to, const plugin::Wait& wait) {
    socket_ = Descriptor(
        ::socket(to.ai_family, to.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, to.ai_protocol));
    if (socket_.number() < 0) return errno;
    if (::connect(socket_.number(), to.ai_addr, to.ai_addrlen) == 0) return 0;
    if (errno != EINPROGRESS) return errno;
    if (!wait.ready(socket_.number(), POLLOUT)) return ETIMEDOUT;
    int error = 0;
    socklen_t size = sizeof error;
    ::getsockopt(socket_.number(), SOL_SOCKET, SO_ERROR, &error, &size);
    return error;
  }
  [[noreturn]] void fail(std::int32_t code, const std::string& what) const {
    throw plugin::DeviceError(code, fmt::format("{}: {}", name_, what));
  }

  std::string name_;
  Descriptor socket_;
};

}  // namespace

SourcePlace tcp_source(const std::string& address) {
  return {address, true, [address, at = address_of(address)](const plugin::Wait& wait) {
            return std::make_unique<TcpSource>(address, at, wait);
          }};
}

}  // namespace imunoise::text
