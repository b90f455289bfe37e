#include "daemon/service/http/listen_address.h"

#include <charconv>

namespace imunoise::service {

Result<LoopbackAddress> parse_listen(std::string_view text) {
  const std::size_t colon = text.rfind(':');
  LoopbackAddress out;
  const char* const end = text.data() + text.size();
  const auto number = colon == std::string_view::npos
                          ? std::from_chars_result{end, std::errc::invalid_argument}
                          : std::from_chars(text.data() + colon + 1, end, out.port);
  if (number.ec != std::errc() || number.ptr != end)
    return fail("'" + std::string(text) + "': write an address and a port: 127.0.0.1:8080");
  const std::string_view host = text.substr(0, colon);
  out.six = host == "[::1]";
  if (!out.six && host != "127.0.0.1" && host != "localhost")
    return fail(
        "'" + std::string(text) +
        "': only 127.0.0.1, localhost and [::1]; other machines come through ssh or a proxy that "
        "encrypts");
  return out;
}

}  // namespace imunoise::service
