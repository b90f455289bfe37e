#pragma once

// Between HTTP and the methods: who may come in, what is asked, and how it is answered.

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "daemon/service/access/request_rate.h"
#include "daemon/service/access/sessions.h"
#include "daemon/service/access/tokens.h"
#include "daemon/service/api/methods.h"
#include "daemon/service/api/routes.h"
#include "daemon/service/http/http.h"
#include "daemon/service/page/page.h"
#include "imunoise/v1/service.pb.h"

namespace imunoise::service {

struct ApiHandlerOptions {
  std::optional<Tokens> tokens = {};    ///< Of those who come by TCP.
  std::vector<std::string> hosts = {};  ///< Names of this machine beside localhost.
  double requests_per_second = 50.0;    ///< Of each peer, in the long run,
  double burst = 200.0;                 ///< and at once.
  std::span<const Asset> page = page_assets();
  std::string version = {};
  bool bench = true;  ///< There are campaigns.
};

/// In this order: a peer that asks too often (429; strangers among its requests count apart), a
/// Host that is none of ours or an Origin of another page (403), a target that is none (400), a
/// path (404) or verb (405) that is not there, no token or a wrong one (401), a role that may not
/// (403), a body that is no JSON (415).
class ApiHandler : public Handler {
 public:
  /// `methods` outlives it. Precondition: it has all methods of `routes` but those of sessions,
  /// which are this object's own.
  ApiHandler(Routes routes, const Methods& methods, ApiHandlerOptions options);

  bool knows(const RequestHead& head) override;
  std::optional<Response> refuse(const RequestHead& head) override;
  bool waits(const RequestHead& head) override;
  Response answer(const Request& request) override;
  Response trouble(unsigned status, const std::string& sentence) override;

  /// A token that opens one session of an operator, once.
  std::string invite() { return sessions_.invite(v1::operator_); }

  /// Responses by status, since the start.
  std::map<unsigned, std::uint64_t> responses() const;

 private:
  struct Asked {
    Target target;
    Found found;
    const Asset* asset = nullptr;  // of the page; then there is no route
  };
  Answer<Asked> understand(const RequestHead& head) const;
  Answer<void> check_sender(const RequestHead& head);
  // Nothing: a stranger, who shows no token of ours.
  std::optional<v1::Role> role_of(const RequestHead& head) const;
  Answer<void> check_role(const RequestHead& head, v1::Role needed) const;
  Answer<Response> call(const Request& request);
  Answer<Response> open_session(const Request& request, const v1::OpenSessionRequest& opening);
  v1::Session session_of(std::optional<v1::Role> role) const;
  Response counted(Response response);
  Response refusal(const Problem& problem);

  const Routes routes_;
  const Methods& methods_;
  const ApiHandlerOptions options_;
  Sessions sessions_;
  RequestRate rate_;
  mutable std::mutex mutex_;
  std::map<unsigned, std::uint64_t> responses_;
};

}  // namespace imunoise::service
