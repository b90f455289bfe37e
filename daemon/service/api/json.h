#pragma once

// Messages to and from what HTTP carries.

#include <memory>
#include <string>

#include "core/support/result.h"
#include "daemon/service/api/routes.h"

namespace google::protobuf {
class Message;
}

namespace imunoise::service {

/// The request of a route out of its path's and query's texts and its body, a JSON object (empty:
/// no field is set). Error: no JSON, an unknown field or parameter, a text that is no number, a
/// field that path and body name differently.
Result<std::unique_ptr<google::protobuf::Message>> request_of(const Route& route,
                                                              const TextFields& path,
                                                              const TextFields& query,
                                                              const std::string& body);

/// As the house writes JSON (study/report/json.h), indented, or in one line for events.
std::string response_text(const google::protobuf::Message& message);
std::string event_text(const std::string& name, const google::protobuf::Message& message);

}  // namespace imunoise::service
