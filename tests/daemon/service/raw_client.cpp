#include "tests/daemon/service/raw_client.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <utility>

namespace imunoise::testing {
namespace {

template <class Address>
int connected(int family, const Address& address) {
  const int out = ::socket(family, SOCK_STREAM | SOCK_CLOEXEC, 0);
  EXPECT_EQ(::connect(out, static_cast<const sockaddr*>(static_cast<const void*>(&address)),
                      sizeof address),
            0);
  timeval patience{5, 0};
  ::setsockopt(out, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
  return out;
}

int connect_to(const Where& where) {
  if (!where.socket.empty()) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    where.socket.string().copy(address.sun_path, sizeof address.sun_path - 1);
    return connected(AF_UNIX, address);
  }
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(where.port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return connected(AF_INET, address);
}

std::size_t content_length(const std::string& head) {
  const std::size_t at = head.find("Content-Length: ");
  return at == std::string::npos ? std::string::npos
                                 : std::strtoul(head.c_str() + at + 16, nullptr, 10);
}

}  // namespace

RawClient::RawClient(const Where& where) : socket_(connect_to(where)) {}
RawClient::RawClient(RawClient&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)),
      received_(std::move(other.received_)),
      ended_(other.ended_) {}
RawClient::~RawClient() {
  if (socket_ >= 0) ::close(socket_);
}

bool RawClient::send(std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t done = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (done <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(done));
  }
  return true;
}

void RawClient::end_sending() const { ::shutdown(socket_, SHUT_WR); }

bool RawClient::more(std::chrono::steady_clock::time_point deadline) {
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
      deadline - std::chrono::steady_clock::now());
  pollfd waiting{socket_, POLLIN, 0};
  if (left.count() < 0 || ::poll(&waiting, 1, static_cast<int>(left.count())) != 1) return false;
  char buffer[65536];
  const ssize_t got = ::recv(socket_, buffer, sizeof buffer, 0);
  if (got <= 0) {
    ended_ = true;
    return false;
  }
  received_.append(buffer, static_cast<std::size_t>(got));
  return true;
}

RawResponse RawClient::receive(std::chrono::milliseconds patience) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  std::size_t body = received_.find("\r\n\r\n");
  while (body == std::string::npos && more(deadline)) body = received_.find("\r\n\r\n");
  if (body == std::string::npos) return {};
  RawResponse out;
  out.head = received_.substr(0, body + 4);
  out.status = std::atoi(out.head.c_str() + 9);
  const bool stream = out.head.find("text/event-stream") != std::string::npos;
  const std::size_t length = stream ? 0 : content_length(out.head);
  while (received_.size() - out.head.size() < length && more(deadline)) {
  }
  out.body = received_.substr(out.head.size(), length);
  received_.erase(0, out.head.size() + out.body.size());
  return out;
}

std::string RawClient::receive_until(std::string_view words, std::chrono::milliseconds patience) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (received_.find(words) == std::string::npos && more(deadline)) {
  }
  return received_;
}

bool RawClient::closed(std::chrono::milliseconds patience) {
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (more(deadline)) received_.clear();
  return ended_;
}

std::string request_text(std::string_view verb, std::string_view target,
                         const std::vector<std::string>& headers, std::string_view body) {
  std::string out = std::string(verb) + " " + std::string(target) + " HTTP/1.1\r\n";
  bool host = false;
  for (const std::string& one : headers) {
    out += one + "\r\n";
    host = host || one.starts_with("Host:");
  }
  if (!host) out += "Host: localhost\r\n";
  if (!body.empty()) out += "Content-Length: " + std::to_string(body.size()) + "\r\n";
  return out + "\r\n" + std::string(body);
}

RawResponse send_one(const Where& where, const std::string& request) {
  RawClient client(where);
  EXPECT_TRUE(client.send(request));
  return client.receive();
}

RawResponse get(const Where& where, std::string_view target,
                const std::vector<std::string>& headers) {
  return send_one(where, request_text("GET", target, headers));
}

RawResponse post(const Where& where, std::string_view target, std::string_view json,
                 const std::vector<std::string>& headers) {
  std::vector<std::string> all = headers;
  all.emplace_back("Content-Type: application/json");
  return send_one(where, request_text("POST", target, all, json));
}

}  // namespace imunoise::testing
