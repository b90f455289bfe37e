#pragma once

// Which method of the API a request means, by the options of its services
// (proto/imunoise/v1/http.proto).

#include <string>
#include <utility>
#include <vector>

#include "daemon/service/access/http_target.h"
#include "imunoise/v1/http.pb.h"

namespace google::protobuf {
class FileDescriptor;
class MethodDescriptor;
}  // namespace google::protobuf

namespace imunoise::service {

/// A piece of a route's path: a word, or a field of the request.
struct PathPart {
  std::string name;
  bool field = false;
  bool rest = false;  ///< The field takes all segments that follow, at least one.
};

struct Route {
  const google::protobuf::MethodDescriptor* method = nullptr;
  std::string verb;  ///< "GET", "POST" or "DELETE"
  std::string path;  ///< As the option has it.
  std::vector<PathPart> parts;
  v1::Http http;
};

/// Fields of a request by name, as texts.
using TextFields = std::vector<std::pair<std::string, std::string>>;

struct Found {
  const Route* route = nullptr;  ///< Null: no such path, or not with this verb.
  TextFields fields;             ///< From the path.
  std::string allowed;           ///< Verbs that the path has: "GET, POST"; empty: no such path.
};

/// One for each method of all services of a file, in their order. Thread-safe.
class Routes {
 public:
  explicit Routes(const google::protobuf::FileDescriptor& file);

  Found find(const std::string& verb, const Target& target) const;
  const std::vector<Route>& all() const { return routes_; }

 private:
  std::vector<Route> routes_;
};

}  // namespace imunoise::service
