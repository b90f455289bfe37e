#include "daemon/service/api/api_handler.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>

#include <cassert>
#include <utility>

#include "daemon/service/access/origin.h"
#include "daemon/service/api/json.h"
#include "imunoise/v1/service.pb.h"

namespace imunoise::service {
namespace {

constexpr unsigned kDone = 200;
constexpr unsigned kAccepted = 202;

bool is_json(const std::string& content_type) {
  const std::string kind = content_type.substr(0, content_type.find(';'));
  return kind == "application/json" || kind == "application/json ";
}

// A job that goes on after the response.
bool goes_on(const Route& route, const google::protobuf::Message& message) {
  const auto* const job = dynamic_cast<const v1::Job*>(&message);
  return route.verb == "POST" && job != nullptr &&
         (job->state() == v1::queued || job->state() == v1::working);
}

// Which methods this object answers itself: they are about who asks.
bool is_session(const google::protobuf::Descriptor* request) {
  return request == v1::OpenSessionRequest::descriptor() ||
         request == v1::GetSessionRequest::descriptor();
}

Response response_of(const Route& route, const Reply& reply) {
  if (reply.events) return {kDone, "text/event-stream", "", {}, reply.events};
  if (!route.http.produces().empty()) {
    return {kDone, route.http.produces(), dynamic_cast<const v1::Text&>(*reply.message).text()};
  }
  return {goes_on(route, *reply.message) ? kAccepted : kDone, "application/json",
          response_text(*reply.message)};
}

}  // namespace

ApiHandler::ApiHandler(Routes routes, const Methods& methods, ApiHandlerOptions options)
    : routes_(std::move(routes)),
      methods_(methods),
      options_(std::move(options)),
      rate_(options_.requests_per_second, options_.burst) {
  for ([[maybe_unused]] const Route& route : routes_.all()) {
    assert(is_session(route.method->input_type()) || methods_.has(route.method->input_type()));
  }
}

std::optional<v1::Role> ApiHandler::role_of(const RequestHead& head) const {
  if (head.peer.local) return v1::operator_;
  const auto token = bearer_token(head.authorization);
  if (token) return options_.tokens ? options_.tokens->role_of(*token) : std::nullopt;
  return sessions_.role_of(cookie_value(head.cookie, cookie_name(head.host)));
}

bool ApiHandler::knows(const RequestHead& head) { return role_of(head).has_value(); }

Answer<void> ApiHandler::check_sender(const RequestHead& head) {
  const std::string peer = head.peer.name + (knows(head) ? "" : ", a stranger");
  if (!rate_.pass(peer, std::chrono::steady_clock::now()))
    return service::refuse(429, "too many requests; try again in a second");
  if (!known_host(head.host, options_.hosts))
    return service::refuse(403, "the header Host names another machine; ask for localhost");
  if (!same_origin(head.origin, head.host))
    return service::refuse(403,
                           "the header Origin names another site; its pages cannot use this API");
  return {};
}

Answer<ApiHandler::Asked> ApiHandler::understand(const RequestHead& head) const {
  auto target = parse_target(head.target);
  if (!target) return service::refuse(400, target.error().message);
  Found found = routes_.find(head.method, *target);
  if (found.allowed.empty() && head.method == "GET") {
    if (const Asset* const asset = find_asset(options_.page, target->segments))
      return Asked{std::move(*target), {}, asset};
  }
  if (found.allowed.empty())
    return service::refuse(404, "there is no such path; /openapi.json lists all");
  if (found.route == nullptr)
    return service::refuse(405, "this path takes " + found.allowed + " alone");
  return Asked{std::move(*target), std::move(found)};
}

Answer<void> ApiHandler::check_role(const RequestHead& head, v1::Role needed) const {
  if (needed == v1::anyone) return {};
  const auto role = role_of(head);
  if (!role)
    return service::refuse(401, "missing or unknown token; send Authorization: Bearer TOKEN");
  if (*role < needed) return service::refuse(403, "this needs an operator token");
  return {};
}

std::optional<Response> ApiHandler::refuse(const RequestHead& head) {
  if (auto good = check_sender(head); !good) return refusal(good.error());
  const auto asked = understand(head);
  if (!asked) return refusal(asked.error());
  if (asked->asset != nullptr) return std::nullopt;  // holds nothing that is secret
  if (auto good = check_role(head, asked->found.route->http.role()); !good)
    return refusal(good.error());
  if (head.method == "POST" && !is_json(head.content_type))
    return refusal({415, "send the header Content-Type: application/json"});
  return std::nullopt;
}

bool ApiHandler::waits(const RequestHead& head) {
  const auto asked = understand(head);
  if (!asked || asked->asset != nullptr) return false;
  const auto* const request = asked->found.route->method->input_type();
  return !is_session(request) && methods_.waits(request);
}

v1::Session ApiHandler::session_of(std::optional<v1::Role> role) const {
  v1::Session out;
  out.set_role(role.value_or(v1::role_unspecified));
  out.set_version(options_.version);
  out.set_bench(options_.bench);
  return out;
}

Answer<Response> ApiHandler::open_session(const Request& request,
                                          const v1::OpenSessionRequest& opening) {
  if (opening.token().empty()) return service::refuse(400, "token: missing");
  auto role = sessions_.redeem(opening.token());
  if (!role && options_.tokens) role = options_.tokens->role_of(opening.token());
  if (!role)
    return service::refuse(401, "unknown token, or one that was used; ask for another token");
  Response out{kDone, "application/json", response_text(session_of(role))};
  out.headers.emplace_back("Set-Cookie", cookie_name(request.host) + "=" + sessions_.open(*role) +
                                             "; HttpOnly; SameSite=Strict; Path=/");
  return out;
}

Answer<Response> ApiHandler::call(const Request& request) {
  const auto asked = understand(request);
  if (!asked) return tl::unexpected(asked.error());
  if (asked->asset != nullptr) return asset_response(*asked->asset, request);
  const Route& route = *asked->found.route;
  const auto message = request_of(route, asked->found.fields, asked->target.query, request.body);
  if (!message) return service::refuse(400, message.error().message);
  if (const auto* opening = dynamic_cast<const v1::OpenSessionRequest*>(message->get()))
    return open_session(request, *opening);
  if (route.method->input_type() == v1::GetSessionRequest::descriptor())
    return Response{kDone, "application/json", response_text(session_of(role_of(request)))};
  const auto reply = methods_.call(**message);
  if (!reply) return tl::unexpected(reply.error());
  return response_of(route, *reply);
}

Response ApiHandler::answer(const Request& request) {
  try {
    auto response = call(request);
    return response ? counted(std::move(*response)) : refusal(response.error());
  } catch (const std::exception& error) {  // of a library, or of the memory
    return refusal({500, std::string("internal error of imunoised: ") + error.what()});
  }
}

Response ApiHandler::trouble(unsigned status, const std::string& sentence) {
  return refusal({status, sentence});
}

Response ApiHandler::refusal(const Problem& problem) {
  v1::Refusal body;
  body.set_error(problem.sentence);
  Response out{problem.status, "application/json", response_text(body)};
  if (problem.status == 401) out.headers.emplace_back("WWW-Authenticate", "Bearer");
  if (problem.status == 429 || problem.status == 503) out.headers.emplace_back("Retry-After", "1");
  return counted(std::move(out));
}

Response ApiHandler::counted(Response response) {
  const std::lock_guard lock(mutex_);
  ++responses_[response.status];
  return response;
}

std::map<unsigned, std::uint64_t> ApiHandler::responses() const {
  const std::lock_guard lock(mutex_);
  return responses_;
}

}  // namespace imunoise::service
