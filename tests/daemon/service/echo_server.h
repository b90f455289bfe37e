#pragma once

// A server whose answers are what it was asked.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>

#include "daemon/service/http/http_server.h"
#include "tests/daemon/service/raw_client.h"
#include "tests/study/simulated_recording.h"

namespace imunoise::service {

// Answers with what it was asked, or with a stream of events.
class Echo : public Handler {
 public:
  bool knows(const RequestHead& head) override {
    return head.peer.local || !head.authorization.empty();
  }
  std::optional<Response> refuse(const RequestHead& head) override {
    if (head.target == "/refused") return Response{403, "text/plain", "refused"};
    return std::nullopt;
  }
  bool waits(const RequestHead& head) override {
    return head.target == "/slow" || head.target == "/hanging";
  }
  Response answer(const Request& request) override {
    ++answered;
    if (request.target == "/slow") std::this_thread::sleep_for(std::chrono::milliseconds(300));
    if (request.target == "/hanging") let_go.wait(false);
    if (request.target == "/large") return {200, "text/plain", std::string(64U << 20U, 'x')};
    if (request.target != "/events")
      return {200, "text/plain", request.method + " " + request.target + " " + request.body};
    events = std::make_shared<EventQueue>(64, 1U << 20U);
    events->push(std::make_shared<const std::string>("data: first\n\n"));
    return {200, "text/event-stream", "", {}, events};
  }
  Response trouble(unsigned status, const std::string& sentence) override {
    return {status, "text/plain", sentence};
  }

  std::atomic<int> answered = 0;
  std::atomic<bool> let_go = false;
  std::shared_ptr<EventQueue> events;
};

class Server : public ::testing::Test {
 protected:
  void start() {
    auto server = HttpServer::start({where_.socket, std::nullopt}, limits_, echo_);
    ASSERT_TRUE(server.has_value()) << server.error().message;
    server_ = std::move(*server);
  }
  std::string get_text(const std::string& target = "/") const {
    return testing::get(where_, target).body;
  }
  // The counter comes to be so, soon.
  template <class Counter>
  bool comes(Counter HttpCounters::*counter, std::uint64_t value) const {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(5);
    while (server_->counters().*counter != value) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
  }

  const testing::TemporaryFolder folder_;
  testing::Where where_{folder_.path() / "api.sock", 0};
  HttpLimits limits_;
  Echo echo_;
  std::unique_ptr<HttpServer> server_;
};

}  // namespace imunoise::service
