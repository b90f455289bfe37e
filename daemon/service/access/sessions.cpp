#include "daemon/service/access/sessions.h"

#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "daemon/service/access/tokens.h"

namespace imunoise::service {
namespace {

constexpr std::size_t kMostSessions = 256;

// 256 bits that nobody can guess, as 64 hexadecimal digits.
std::string secret() {
  std::array<unsigned char, 32> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw std::runtime_error("the system gives no random numbers");
  std::string out;
  for (const unsigned char one : bytes) out += fmt::format("{:02x}", one);
  return out;
}

}  // namespace

std::string Sessions::invite(v1::Role role) {
  const std::lock_guard lock(mutex_);
  return invitations_.emplace_back(Pass{secret(), role}).text;
}

std::optional<v1::Role> Sessions::redeem(std::string_view token) {
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(invitations_.begin(), invitations_.end(),
                                  [&](const Pass& one) { return same_secret(one.text, token); });
  if (found == invitations_.end()) return std::nullopt;
  const v1::Role role = found->role;
  invitations_.erase(found);
  return role;
}

std::string Sessions::open(v1::Role role) {
  const std::lock_guard lock(mutex_);
  if (sessions_.size() == kMostSessions) sessions_.pop_front();
  return sessions_.emplace_back(Pass{secret(), role}).text;
}

std::optional<v1::Role> Sessions::role_of(std::string_view session) const {
  const std::lock_guard lock(mutex_);
  std::optional<v1::Role> out;
  for (const Pass& one : sessions_) {
    if (same_secret(one.text, session)) out = one.role;
  }
  return out;
}

std::string cookie_name(std::string_view host) {
  const std::size_t colon = host.rfind(':');
  const std::string_view port = colon == std::string_view::npos ? "" : host.substr(colon + 1);
  const bool digits =
      std::all_of(port.begin(), port.end(), [](char c) { return c >= '0' && c <= '9'; });
  return "imunoise" + (digits && !port.empty() ? "_" + std::string(port) : "");
}

std::string_view cookie_value(std::string_view header, std::string_view name) {
  while (!header.empty()) {
    const std::size_t end = std::min(header.find(';'), header.size());
    std::string_view pair = header.substr(0, end);
    while (pair.starts_with(' ')) pair.remove_prefix(1);
    if (pair.starts_with(name) && pair.substr(name.size()).starts_with('='))
      return pair.substr(name.size() + 1);
    header.remove_prefix(std::min(end + 1, header.size()));
  }
  return {};
}

}  // namespace imunoise::service
