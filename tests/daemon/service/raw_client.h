#pragma once

// A client that sends exactly the bytes it is told: what a browser or curl would never send, too.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace imunoise::testing {

struct RawResponse {
  int status = 0;  ///< 0: none came
  std::string head;
  std::string body;
};

/// Where a server listens.
struct Where {
  std::filesystem::path socket;  ///< empty: TCP
  std::uint16_t port = 0;
};

/// One connection. A failure to connect is one of the running test.
class RawClient {
 public:
  explicit RawClient(const Where& where);
  ~RawClient();
  RawClient(RawClient&& other) noexcept;
  RawClient& operator=(RawClient&&) = delete;
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  /// False: the other side has closed, or does not read any more for five seconds.
  bool send(std::string_view bytes) const;
  void end_sending() const;
  /// What comes until there is a whole response (by its Content-Length; of a stream of events the
  /// head), the other side closes, or the time is over.
  RawResponse receive(std::chrono::milliseconds patience = std::chrono::seconds(10));
  /// What comes until the text holds `words`, the other side closes, or the time is over.
  std::string receive_until(std::string_view words,
                            std::chrono::milliseconds patience = std::chrono::seconds(10));
  /// The other side closes within the time. What comes is thrown away.
  bool closed(std::chrono::milliseconds patience = std::chrono::seconds(10));

 private:
  // False at the end, and when nothing comes.
  bool more(std::chrono::steady_clock::time_point deadline);

  int socket_;
  std::string received_;
  bool ended_ = false;
};

/// A whole request; Host is localhost unless `headers` has one.
std::string request_text(std::string_view verb, std::string_view target,
                         const std::vector<std::string>& headers = {}, std::string_view body = "");

/// Sends one request on a connection of its own.
RawResponse send_one(const Where& where, const std::string& request);
RawResponse get(const Where& where, std::string_view target,
                const std::vector<std::string>& headers = {});
/// With a body of JSON.
RawResponse post(const Where& where, std::string_view target, std::string_view json = "{}",
                 const std::vector<std::string>& headers = {});

}  // namespace imunoise::testing
