#pragma once

// Where the service listens, as its user writes it.

#include <cstdint>
#include <string>
#include <string_view>

#include "core/support/result.h"

namespace imunoise::service {

struct LoopbackAddress {
  bool six = false;  ///< ::1 instead of 127.0.0.1
  std::uint16_t port = 0;
};

/// "127.0.0.1:8080", "localhost:8080", "[::1]:8080"; port 0: any that is free. Error: another
/// form, or an address that other machines reach.
Result<LoopbackAddress> parse_listen(std::string_view text);

}  // namespace imunoise::service
