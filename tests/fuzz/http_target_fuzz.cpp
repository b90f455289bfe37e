// Any text as a request's target, Host, Origin, Authorization and file of tokens: refused, or
// nothing in it that leads elsewhere, and the same when it is written anew.

#include <cstdint>
#include <cstdlib>
#include <string>

#include "daemon/service/access/http_target.h"
#include "daemon/service/access/origin.h"
#include "daemon/service/access/tokens.h"

namespace {

using imunoise::service::Target;

void require(bool holds) {
  if (!holds) std::abort();
}

std::string encoded(const std::string& text) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    out += '%';
    out += kDigits[byte / 16];
    out += kDigits[byte % 16];
  }
  return out;
}

std::string written(const Target& target) {
  std::string out = target.segments.empty() ? "/" : "";
  for (const std::string& one : target.segments) out += "/" + encoded(one);
  char before = '?';
  for (const auto& [name, value] : target.query) {
    out += before + encoded(name) + "=" + encoded(value);
    before = '&';
  }
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(static_cast<const char*>(static_cast<const void*>(data)), size);
  const std::string name = imunoise::service::host_name(text);
  if (imunoise::service::known_host(text, {})) {
    require(name == "localhost" || name == "127.0.0.1" || name == "[::1]");
  }
  if (!text.empty() && imunoise::service::same_origin(text, "localhost")) {
    require(text.ends_with("localhost") || text.size() == 16 || text.size() == 17);
  }
  if (const auto tokens = imunoise::service::Tokens::parse(text)) {
    require(!tokens->role_of("") && size >= 39);
  }
  const auto target = imunoise::service::parse_target(text);
  if (!target) return 0;
  for (const std::string& one : target->segments) {
    require(!one.empty() && one != "." && one != "..");
    require(one.find_first_of("/\\\r\n\x7f") == std::string::npos);
    require(one.find('\0') == std::string::npos);
  }
  const std::string again = written(*target);
  if (again.size() > 4096) return 0;
  const auto second = imunoise::service::parse_target(again);
  require(second && second->segments == target->segments && second->query == target->query);
  return 0;
}
