// The client that follows a daemon in which little happens.

#include "cli/client/daemon_client.h"

#include <gtest/gtest.h>

#include <thread>

#include "daemon/service/http/http_server.h"
#include "tests/study/simulated_recording.h"

namespace imunoise::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

// A stream with one event.
class Quiet : public service::Handler {
 public:
  bool knows(const service::RequestHead& /*head*/) override { return true; }
  std::optional<service::Response> refuse(const service::RequestHead& /*head*/) override {
    return std::nullopt;
  }
  bool waits(const service::RequestHead& /*head*/) override { return false; }
  service::Response answer(const service::Request& /*request*/) override {
    const auto events = std::make_shared<service::EventQueue>(64, 1U << 20U);
    events->push(std::make_shared<const std::string>("event: first\ndata: 1\n\n"));
    return {200, "text/event-stream", "", {}, events};
  }
  service::Response trouble(unsigned status, const std::string& sentence) override {
    return {status, "text/plain", sentence};
  }
};

class DaemonClientTest : public ::testing::Test {
 protected:
  struct Followed {
    Result<void> result;
    int events = 0;
    Clock::duration took{};
  };

  // Until it falls silent for so long, or somebody has followed long enough.
  Followed follow(std::chrono::milliseconds heartbeat, std::chrono::milliseconds silence,
                  std::chrono::milliseconds enough) {
    service::HttpLimits limits;
    limits.heartbeat = heartbeat;
    const auto server = service::HttpServer::start({socket_, std::nullopt}, limits, handler_);
    EXPECT_TRUE(server.has_value());
    auto client = DaemonClient::open({socket_, "", std::nullopt});
    EXPECT_TRUE(client.has_value());
    Followed out;
    std::stop_source stop;
    const std::jthread stopper([&](const std::stop_token& over) {
      const auto until = Clock::now() + enough;
      while (!over.stop_requested() && Clock::now() < until) std::this_thread::sleep_for(10ms);
      stop.request_stop();
    });
    const auto begin = Clock::now();
    out.result = client->follow(
        "/events", [&](std::string_view, const std::string&) { return ++out.events > 0; },
        stop.get_token(), silence);
    out.took = Clock::now() - begin;
    return out;
  }

  const testing::TemporaryFolder folder_;
  const std::filesystem::path socket_ = folder_.path() / "api.sock";
  Quiet handler_;
};

TEST_F(DaemonClientTest, AHeartbeatIsEnough) {
  const Followed followed = follow(200ms, 2s, 4s);
  EXPECT_TRUE(followed.result) << followed.result.error().message;
  EXPECT_EQ(followed.events, 1);
  EXPECT_GE(followed.took, 4s);
}

TEST_F(DaemonClientTest, SilenceIsTold) {
  const Followed followed = follow(1h, 1s, 1min);
  ASSERT_FALSE(followed.result);
  EXPECT_NE(followed.result.error().message.find("stopped sending"), std::string::npos)
      << followed.result.error().message;
  EXPECT_EQ(followed.events, 1);
}

}  // namespace
}  // namespace imunoise::cli
