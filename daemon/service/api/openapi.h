#pragma once

#include <string>

#include "daemon/service/api/routes.h"

namespace imunoise::service {

/// The API as an OpenAPI 3.0 document: made from the descriptors of the routes' methods and
/// messages, with the comments of their files.
std::string openapi_document(const Routes& routes, const std::string& version);

}  // namespace imunoise::service
