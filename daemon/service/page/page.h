#pragma once

// The page's files, which are part of the program, as responses.

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/service/http/http.h"

namespace imunoise::service {

/// A file of the page.
struct Asset {
  std::string_view path;  ///< "/index.html"
  std::string_view etag;  ///< with its quotation marks
  std::string_view gzip;  ///< its bytes, compressed
};

/// All that were embedded when the program was built; none where it was built without the page.
std::span<const Asset> page_assets();

/// The file at a path of segments (none: the page itself); null where there is none.
const Asset* find_asset(std::span<const Asset> assets, const std::vector<std::string>& segments);

/// A response that a browser may keep: 304 where it has the file, 406 where it takes no gzip. Of
/// the page itself with a policy that allows nothing but the page's own files.
Response asset_response(const Asset& asset, const RequestHead& head);

}  // namespace imunoise::service
