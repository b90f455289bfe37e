#pragma once

// Whether a request was meant for this service: against pages that use a browser as their hand
// (DNS rebinding, requests across sites).

#include <string>
#include <string_view>
#include <vector>

namespace imunoise::service {

/// The name in "localhost:8080" or "[::1]:8080", in lower case; empty where it is none.
std::string host_name(std::string_view host);

/// localhost, 127.0.0.1, [::1], or one of `more`, with any port.
bool known_host(std::string_view host, const std::vector<std::string>& more);

/// No Origin, or that of the service itself: "http://" or "https://" before the Host.
bool same_origin(std::string_view origin, std::string_view host);

}  // namespace imunoise::service
