#pragma once

// HTTP/1.1 on a Unix socket, on loopback TCP, or both. Boost.Beast stays behind this header.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "core/support/result.h"
#include "daemon/service/http/http.h"

namespace imunoise::service {

/// What one client, and all of them together, may take. Serving gives way to recording.
struct HttpLimits {
  std::size_t header_bytes = 16U << 10U;
  std::size_t body_bytes = 1U << 20U;
  /// From the connection's beginning until the head of its first request is there,
  std::chrono::milliseconds first_head{2'000};
  /// and from then on, or the end of the response before, until a whole request is there, however
  /// its bytes are dripped in.
  std::chrono::milliseconds request{10'000};
  /// Until the other side has taken a response, or all events that waited.
  std::chrono::milliseconds response{10'000};
  std::chrono::milliseconds heartbeat{15'000};  ///< Of a stream of events that has none.
  std::size_t connections = 64;                 ///< At once; others are told to come back.
  std::size_t connections_of_peer = 48;         ///< The others are left for other peers.
  std::size_t strangers = 16;                   ///< Among these, until they show who they are.
  std::size_t streams = 16;                     ///< Of events, among these.
  std::size_t waiting_threads = 4;              ///< That answer requests which may wait for a disk,
  std::size_t prompt_threads = 2;               ///< and all others.
};

struct Listen {
  std::optional<std::filesystem::path> socket = {};  ///< Made with mode 0660.
  std::optional<std::string> address = {};  ///< "127.0.0.1:8080"; port 0: any that is free.
};

/// Since the start.
struct HttpCounters {
  std::uint64_t connections = 0;  ///< Open now.
  std::uint64_t streams = 0;      ///< Open now.
  std::uint64_t accepted = 0;
  std::uint64_t turned_away = 0;      ///< Too many were there.
  std::uint64_t evicted = 0;          ///< Made room for others: strangers, and those that idled.
  std::uint64_t timed_out = 0;        ///< Took too long to send a request or to take a response.
  std::uint64_t malformed = 0;        ///< No HTTP, or beyond a limit of size.
  std::uint64_t streams_dropped = 0;  ///< Their readers were too slow.
};

/// Runs its own threads. Functions are thread-safe.
class HttpServer {
 public:
  /// Listens from then on. `handler` outlives it. Error: nothing to listen on, an address that is
  /// not loopback or is in use, a socket that another process serves or that cannot be made.
  static Result<std::unique_ptr<HttpServer>> start(const Listen& listen, const HttpLimits& limits,
                                                   Handler& handler);
  /// Ends all connections; waits for answers that are being made.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  HttpCounters counters() const;
  std::uint16_t port() const;  ///< Of TCP; 0 without it.

 private:
  class Implementation;
  explicit HttpServer(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace imunoise::service
