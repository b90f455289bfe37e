#include "cli/client/daemon_client.h"

#include <curl/curl.h>
#include <fmt/format.h>
#include <google/protobuf/message.h>
#include <google/protobuf/util/json_util.h>

#include <chrono>
#include <fstream>

#include "cli/client/event_reader.h"
#include "imunoise/v1/service.pb.h"
#include "study/report/json.h"
#include "study/words/text.h"

namespace imunoise::cli {
namespace {

constexpr long kPatience = 30;  // s, for an answer
constexpr std::size_t kLargest = std::size_t{256} << 20U;

Result<std::string> token_in(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string token;
  if (!(in >> token)) return fail(file.string() + ": contains no token; write the token into it");
  return token;
}

// What comes in: an answer, or events.
struct Incoming {
  using Clock = std::chrono::steady_clock;
  bool silent() const { return silence && Clock::now() > last + *silence; }

  std::string text;
  EventReader events;
  const TakeEvent* take = nullptr;  // of events that are wanted
  bool enough = false;
  std::optional<std::chrono::milliseconds> silence = {};  // the longest that is borne
  Clock::time_point last = Clock::now();                  // when something came
  std::stop_token stop;
  CURL* curl = nullptr;
};

std::size_t take_bytes(const char* bytes, std::size_t size, std::size_t count, void* to) {
  auto& incoming = *static_cast<Incoming*>(to);
  const std::string_view part(bytes, size * count);
  incoming.last = Incoming::Clock::now();
  long status = 0;
  curl_easy_getinfo(incoming.curl, CURLINFO_RESPONSE_CODE, &status);
  if (incoming.take != nullptr && status == 200) {
    incoming.enough = !incoming.events.push(part, *incoming.take);
    return incoming.enough ? 0 : part.size();
  }
  if (incoming.text.size() + part.size() > kLargest) return 0;
  incoming.text += part;
  return part.size();
}

// libcurl asks at least once a second. Its own limit on slow transfers takes a heartbeat now and
// then for none.
int go_on(void* from, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
  const auto& incoming = *static_cast<const Incoming*>(from);
  return incoming.stop.stop_requested() || incoming.silent() ? 1 : 0;
}

std::string refusal_in(const std::string& json, long status) {
  v1::Refusal refusal;
  if (read_answer(json, refusal) && !refusal.error().empty())
    return report::clean_text(refusal.error());
  return fmt::format("the daemon answers with status {}", status);
}

}  // namespace

struct DaemonClient::Connection {
  explicit Connection(const DaemonArguments& where_)
      : where(where_), curl(curl_easy_init()), headers(nullptr) {}
  ~Connection() {
    curl_slist_free_all(headers);
    curl_easy_cleanup(curl);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void prepare() const {
    curl_easy_setopt(curl, CURLOPT_HTTPHEADER, headers);
    curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);
    curl_easy_setopt(curl, CURLOPT_PROXY, "");
    curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, "http,https");
    curl_easy_setopt(curl, CURLOPT_CONNECTTIMEOUT, kPatience);
    curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, take_bytes);
    curl_easy_setopt(curl, CURLOPT_XFERINFOFUNCTION, go_on);
    curl_easy_setopt(curl, CURLOPT_NOPROGRESS, 0L);
    if (where.url.empty()) curl_easy_setopt(curl, CURLOPT_UNIX_SOCKET_PATH, where.socket.c_str());
  }

  std::string place() const { return where.url.empty() ? where.socket.string() : where.url; }

  // Precondition: verb, body and limits of time are set.
  Result<std::string> ask(const std::string& target, Incoming& incoming) const {
    incoming.curl = curl;
    curl_easy_setopt(curl, CURLOPT_WRITEDATA, &incoming);
    curl_easy_setopt(curl, CURLOPT_XFERINFODATA, &incoming);
    const std::string url = (where.url.empty() ? "http://localhost" : where.url) + target;
    curl_easy_setopt(curl, CURLOPT_URL, url.c_str());
    const CURLcode done = curl_easy_perform(curl);
    if (incoming.enough || incoming.stop.stop_requested()) return std::string();
    if (incoming.silent())
      return fail(place() + ": stopped sending; check the machine of imunoised");
    if (done != CURLE_OK)
      return fail(
          fmt::format("{}: no answer ({}); check that imunoised runs and that you are in the group "
                      "imunoise",
                      place(), curl_easy_strerror(done)));
    long status = 0;
    curl_easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &status);
    if (status >= 400) return fail(refusal_in(incoming.text, status));
    return std::move(incoming.text);
  }

  const DaemonArguments where;
  CURL* const curl;
  curl_slist* headers;
};

Result<DaemonClient> DaemonClient::open(const DaemonArguments& where) {
  auto connection = std::make_shared<Connection>(where);
  if (connection->curl == nullptr) return fail("libcurl cannot be used");
  connection->headers = curl_slist_append(connection->headers, "Content-Type: application/json");
  if (where.token_file) {
    const auto token = token_in(*where.token_file);
    if (!token) return tl::unexpected(token.error());
    connection->headers =
        curl_slist_append(connection->headers, ("Authorization: Bearer " + *token).c_str());
  }
  return DaemonClient(std::move(connection));
}

Result<std::string> DaemonClient::get(const std::string& target) {
  curl_easy_reset(connection_->curl);
  connection_->prepare();
  curl_easy_setopt(connection_->curl, CURLOPT_TIMEOUT, kPatience);
  Incoming incoming;
  return connection_->ask(target, incoming);
}

Result<std::string> DaemonClient::post(const std::string& target,
                                       const google::protobuf::Message& request) {
  curl_easy_reset(connection_->curl);
  connection_->prepare();
  curl_easy_setopt(connection_->curl, CURLOPT_TIMEOUT, kPatience);
  const std::string body = report::to_json(request);
  curl_easy_setopt(connection_->curl, CURLOPT_POSTFIELDSIZE, static_cast<long>(body.size()));
  curl_easy_setopt(connection_->curl, CURLOPT_POSTFIELDS, body.c_str());
  Incoming incoming;
  return connection_->ask(target, incoming);
}

Result<void> DaemonClient::follow(const std::string& target, const TakeEvent& take,
                                  const std::stop_token& stop, std::chrono::milliseconds silence) {
  curl_easy_reset(connection_->curl);
  connection_->prepare();
  Incoming incoming;
  incoming.take = &take;
  incoming.silence = silence;
  incoming.stop = stop;
  const auto done = connection_->ask(target, incoming);
  if (!done) return tl::unexpected(done.error());
  return {};
}

Result<void> read_answer(const std::string& json, google::protobuf::Message& to) {
  google::protobuf::util::JsonParseOptions lenient;
  lenient.ignore_unknown_fields = true;  // of a newer daemon
  const auto status = google::protobuf::util::JsonStringToMessage(json, &to, lenient);
  if (!status.ok())
    return fail("invalid reply from imunoised (not JSON): " + std::string(status.message()));
  return {};
}

std::string escaped(std::string_view text) {
  char* const out = curl_easy_escape(nullptr, text.data(), static_cast<int>(text.size()));
  std::string copy(out == nullptr ? "" : out);
  curl_free(out);
  return copy;
}

}  // namespace imunoise::cli
