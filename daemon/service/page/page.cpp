#include "daemon/service/page/page.h"

#include <algorithm>

namespace imunoise::service {
namespace {

constexpr std::string_view kIndex = "/index.html";
constexpr const char* kPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

const char* type_of(std::string_view path) {
  if (path.ends_with(".html")) return "text/html; charset=utf-8";
  if (path.ends_with(".js")) return "text/javascript; charset=utf-8";
  if (path.ends_with(".css")) return "text/css; charset=utf-8";
  return "image/svg+xml";
}

}  // namespace

const Asset* find_asset(std::span<const Asset> assets, const std::vector<std::string>& segments) {
  std::string path;
  for (const std::string& one : segments) path += "/" + one;
  if (path.empty()) path = kIndex;
  const auto found = std::find_if(assets.begin(), assets.end(),
                                  [&](const Asset& one) { return one.path == path; });
  return found == assets.end() ? nullptr : &*found;
}

Response asset_response(const Asset& asset, const RequestHead& head) {
  if (head.accept_encoding.find("gzip") == std::string::npos)
    return {406, "text/plain; charset=utf-8",
            "the page is compressed; send the header Accept-Encoding: gzip\n"};
  Response out{200, type_of(asset.path), std::string(asset.gzip)};
  out.headers = {{"ETag", std::string(asset.etag)},    {"Cache-Control", "no-cache"},
                 {"Content-Encoding", "gzip"},         {"Vary", "Accept-Encoding"},
                 {"Content-Security-Policy", kPolicy}, {"Referrer-Policy", "no-referrer"}};
  if (head.if_none_match.find(asset.etag) != std::string::npos) {
    out.status = 304;
    out.body.clear();
  }
  return out;
}

}  // namespace imunoise::service
