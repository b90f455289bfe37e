#pragma once

// Requests and responses, as the rest of the service sees them.

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/service/http/event_queue.h"

namespace imunoise::service {

/// Who is at the other end.
struct Peer {
  bool local = false;  ///< On the Unix socket: the file's permissions let it in.
  std::string
      name;  ///< "uid 1000", or "loopback" where that is not known: limits are counted by it.
};

/// What is known before the body is read. Absent headers are empty.
struct RequestHead {
  std::string method;  ///< "GET"
  std::string target;  ///< As it was sent: "/v1/campaigns?campaign=array".
  std::string host;
  std::string origin;
  std::string authorization;
  std::string content_type;
  std::string cookie;
  std::string accept_encoding;
  std::string if_none_match;
  Peer peer;
};

struct Request : RequestHead {
  std::string body;
};

struct Response {
  unsigned status = 200;
  std::string content_type = "application/json";
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers = {};
  std::shared_ptr<EventQueue> events = nullptr;  ///< Set: the body is what comes out of it.
};

/// What a server asks.
class Handler {
 public:
  virtual ~Handler() = default;
  /// Whether the sender has shown who it is. On the network's thread: must not wait.
  virtual bool knows(const RequestHead& head) = 0;
  /// On the network's thread, before the body is read: must not wait. A response refuses the
  /// request, whose body is then not read.
  virtual std::optional<Response> refuse(const RequestHead& head) = 0;
  /// Whether answer() may wait for a disk or a computation. Of requests that refuse() lets pass, on
  /// the network's thread.
  virtual bool waits(const RequestHead& head) = 0;
  /// On one of several threads, which are others for requests that may wait. Must not throw.
  virtual Response answer(const Request& request) = 0;
  /// The response to what is no request, is too large or too much. From any thread.
  virtual Response trouble(unsigned status, const std::string& sentence) = 0;
};

}  // namespace imunoise::service
