#pragma once

// Asks a running imunoised. libcurl stays behind this header.

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

#include "core/support/result.h"

namespace google::protobuf {
class Message;
}

namespace imunoise::cli {

/// Where the daemon answers, and who asks.
struct DaemonArguments {
  std::filesystem::path socket = "/run/imunoise/api.sock";  ///< where systemd's service has it
  std::string url;  ///< "http://127.0.0.1:8080": instead of the socket
  std::optional<std::filesystem::path> token_file;  ///< a bearer token; needed with a URL
};

/// Takes an event's name and data; false: no more.
using TakeEvent = std::function<bool(std::string_view name, const std::string& data)>;

/// One thread at a time. Errors: no answer, the token file, what the daemon rejects
/// (in its own words), an answer that is none.
class DaemonClient {
 public:
  static Result<DaemonClient> open(const DaemonArguments& where);

  /// The answer as it came: JSON.
  Result<std::string> get(const std::string& target);
  Result<std::string> post(const std::string& target, const google::protobuf::Message& request);
  /// Hands over events as they come, until the receiver has enough, the caller stops it,
  /// or the daemon ends. Error: not even a heartbeat came for so long (the daemon's own: 15 s).
  Result<void> follow(const std::string& target, const TakeEvent& take, const std::stop_token& stop,
                      std::chrono::milliseconds silence = std::chrono::minutes(1));

 private:
  struct Connection;
  explicit DaemonClient(std::shared_ptr<Connection> connection)
      : connection_(std::move(connection)) {}
  std::shared_ptr<Connection> connection_;
};

/// A message out of an answer; what this program does not know is passed over. Error: it is none.
Result<void> read_answer(const std::string& json, google::protobuf::Message& to);

/// What may stand in a target, for any text.
std::string escaped(std::string_view text);

}  // namespace imunoise::cli
