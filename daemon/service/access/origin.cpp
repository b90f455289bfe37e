#include "daemon/service/access/origin.h"

#include <algorithm>
#include <cctype>

namespace imunoise::service {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

bool digits(std::string_view text) {
  return !text.empty() && text.size() <= 5 &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

std::string host_name(std::string_view host) {
  const std::size_t bracket = host.starts_with('[') ? host.find(']') : 0;
  if (bracket == std::string_view::npos) return "";
  const std::size_t colon = host.find(':', bracket);
  if (colon == std::string_view::npos) return lower(host);
  if (!digits(host.substr(colon + 1))) return "";
  return lower(host.substr(0, colon));
}

bool known_host(std::string_view host, const std::vector<std::string>& more) {
  const std::string name = host_name(host);
  return name == "localhost" || name == "127.0.0.1" || name == "[::1]" ||
         (!name.empty() && std::any_of(more.begin(), more.end(),
                                       [&](const std::string& one) { return lower(one) == name; }));
}

bool same_origin(std::string_view origin, std::string_view host) {
  if (origin.empty()) return true;
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (origin.starts_with(scheme)) return lower(origin.substr(scheme.size())) == lower(host);
  }
  return false;
}

}  // namespace imunoise::service
