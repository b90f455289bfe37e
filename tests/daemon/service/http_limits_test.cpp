// The server against clients that are too slow or too many, and streams of events.

#include <netinet/in.h>
#include <sys/socket.h>

#include "daemon/service/http/peer_owner.h"
#include "tests/daemon/service/echo_server.h"

namespace imunoise::service {
namespace {

using namespace std::chrono_literals;
using testing::RawClient;
using testing::Where;
using Clock = std::chrono::steady_clock;

TEST_F(Server, ADrippingClientIsCut) {
  limits_.request = 500ms;
  start();
  for (const std::string& whole : {testing::request_text("GET", "/" + std::string(200, 'x')),
                                   testing::request_text("POST", "/", {}, std::string(200, 'x'))}) {
    RawClient client(where_);
    const auto begin = Clock::now();
    std::size_t sent = 0;
    // The head of the second comes at once, so that it is the body that drips.
    if (whole.starts_with("POST")) client.send(whole.substr(0, sent = whole.size() - 200));
    while (sent < whole.size() && !client.closed(20ms)) client.send(whole.substr(sent++, 1));
    EXPECT_LT(sent, whole.size()) << "it was let drip to the end";
    EXPECT_LT(Clock::now() - begin, 3s);
  }
  EXPECT_EQ(echo_.answered, 0);
  EXPECT_TRUE(comes(&HttpCounters::timed_out, 2));
}

TEST_F(Server, AClientThatSaysNothingIsCut) {
  limits_.request = 200ms;
  start();
  RawClient client(where_);
  EXPECT_TRUE(client.closed(3s));
}

TEST_F(Server, AClientThatDoesNotTakeItsResponseIsCut) {
  limits_.response = 300ms;
  start();
  RawClient client(where_);
  client.send(testing::request_text("GET", "/large"));
  EXPECT_TRUE(comes(&HttpCounters::timed_out, 1));
  EXPECT_TRUE(comes(&HttpCounters::connections, 0));
}

TEST_F(Server, TooManyConnectionsAreTurnedAway) {
  limits_.connections = 3;
  start();
  {
    std::vector<RawClient> clients;
    for (int i = 0; i < 3; ++i) clients.emplace_back(where_);
    ASSERT_TRUE(comes(&HttpCounters::connections, 3));
    RawClient more(where_);
    EXPECT_EQ(more.receive().status, 503);
    EXPECT_EQ(server_->counters().turned_away, 1U);
    clients[0].send(testing::request_text("GET", "/a"));
    EXPECT_EQ(clients[0].receive().body, "GET /a ");
  }
  ASSERT_TRUE(comes(&HttpCounters::connections, 0));
  EXPECT_EQ(get_text("/b"), "GET /b ");
}

TEST_F(Server, OnePeerLeavesConnectionsForOthers) {
  limits_.connections_of_peer = 2;
  auto server = HttpServer::start({where_.socket, "127.0.0.1:0"}, limits_, echo_);
  ASSERT_TRUE(server.has_value());
  server_ = std::move(*server);
  const RawClient first(where_);
  const RawClient second(where_);
  ASSERT_TRUE(comes(&HttpCounters::connections, 2));
  RawClient third(where_);  // is told so at once, and need not ask
  EXPECT_EQ(third.receive().status, 503);
  EXPECT_EQ(testing::get({"", server_->port()}, "/a").status, 200);
}

TEST_F(Server, IdleConnectionsMakeRoomOldestFirst) {
  limits_.connections_of_peer = 3;
  start();
  const auto ask = [](RawClient& client) {
    client.send(testing::request_text("GET", "/a"));
    return client.receive().status;
  };
  std::vector<RawClient> clients;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(ask(clients.emplace_back(where_)), 200);
  EXPECT_EQ(ask(clients[0]), 200) << "it is the last one now";
  RawClient more(where_);
  EXPECT_EQ(ask(more), 200);
  EXPECT_TRUE(clients[1].closed());
  EXPECT_EQ(ask(clients[0]), 200);
  EXPECT_EQ(ask(clients[2]), 200);
  EXPECT_EQ(server_->counters().evicted, 1U);
  EXPECT_EQ(server_->counters().turned_away, 0U);
}

TEST_F(Server, WhoIsAnsweredIsNotEvicted) {
  limits_.connections_of_peer = 1;
  start();
  RawClient first(where_);
  first.send(testing::request_text("GET", "/slow"));
  while (echo_.answered < 1) std::this_thread::sleep_for(1ms);
  RawClient second(where_);
  EXPECT_EQ(second.receive().status, 503);
  EXPECT_EQ(first.receive().status, 200);
}

TEST_F(Server, StrangersAreFewAndMakeRoom) {
  limits_.strangers = 2;
  auto server = HttpServer::start({std::nullopt, "127.0.0.1:0"}, limits_, echo_);
  ASSERT_TRUE(server.has_value());
  server_ = std::move(*server);
  const Where tcp{"", server_->port()};
  RawClient known(tcp);
  const auto request = testing::request_text("GET", "/a", {"Authorization: me"});
  known.send(request);
  EXPECT_EQ(known.receive().status, 200);
  std::vector<RawClient> strangers;
  for (int i = 0; i < 3; ++i) strangers.emplace_back(tcp);
  EXPECT_TRUE(strangers[0].closed(1s)) << "at once, for the third";
  strangers[2].send(testing::request_text("GET", "/b"));
  EXPECT_EQ(strangers[2].receive().status, 200);
  known.send(request);
  EXPECT_EQ(known.receive().status, 200);
  EXPECT_EQ(server_->counters().evicted, 1U);
}

TEST_F(Server, TheFirstRequestHasLittleTime) {
  limits_.first_head = 200ms;
  start();
  RawClient silent(where_);
  RawClient client(where_);
  client.send(testing::request_text("GET", "/a"));
  EXPECT_EQ(client.receive().status, 200);
  EXPECT_TRUE(silent.closed(2s));
  EXPECT_FALSE(client.closed(100ms)) << "the next one has more";
}

TEST_F(Server, PeersOnLoopbackAreKnownByTheirUser) {
  const int server = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* const generic = static_cast<sockaddr*>(static_cast<void*>(&address));
  ASSERT_EQ(::bind(server, generic, size), 0);
  ASSERT_EQ(::listen(server, 1), 0);
  ASSERT_EQ(::getsockname(server, generic, &size), 0);
  const RawClient client(Where{"", ntohs(address.sin_port)});
  const int accepted = ::accept4(server, nullptr, nullptr, SOCK_CLOEXEC);
  const auto owner = owner_of_peer(accepted);
  ::close(accepted);
  ::close(server);
  if (!owner) GTEST_SKIP() << "SKIPPED: this kernel does not tell";
  EXPECT_EQ(*owner, ::geteuid());
}

TEST_F(Server, StreamsEventsUntilItsReaderGoes) {
  start();
  {
    RawClient client(where_);
    client.send(testing::request_text("GET", "/events"));
    EXPECT_NE(client.receive_until("first\n\n").find("text/event-stream"), std::string::npos);
    echo_.events->push(std::make_shared<const std::string>("data: second\n\n"));
    EXPECT_NE(client.receive_until("second\n\n").find("second"), std::string::npos);
    EXPECT_EQ(server_->counters().streams, 1U);
  }
  EXPECT_TRUE(comes(&HttpCounters::streams, 0));
  EXPECT_FALSE(echo_.events->open());
  EXPECT_EQ(server_->counters().streams_dropped, 0U);
}

TEST_F(Server, AStreamHasAHeartbeat) {
  limits_.heartbeat = 50ms;
  start();
  RawClient client(where_);
  client.send(testing::request_text("GET", "/events"));
  const std::string beats = client.receive_until(": \n\n: \n\n");
  EXPECT_NE(beats.find(": \n\n: \n\n"), std::string::npos) << beats;
}

TEST_F(Server, AReaderThatDoesNotReadIsDropped) {
  start();
  RawClient client(where_);
  client.send(testing::request_text("GET", "/events"));
  client.receive_until("first");
  const auto event = std::make_shared<const std::string>(std::string(10'000, 'x'));
  const auto begin = Clock::now();
  int told = 0;
  for (; echo_.events->open() && told < 100'000; ++told) {
    echo_.events->push(event);
    if (told % 16 == 0) std::this_thread::sleep_for(1ms);
  }
  EXPECT_LT(told, 1000) << "what the socket, the write under way and the queue hold";
  EXPECT_LT(Clock::now() - begin, 5s) << "who tells does not wait";
  EXPECT_TRUE(comes(&HttpCounters::streams_dropped, 1));
  EXPECT_TRUE(comes(&HttpCounters::connections, 0));
}

TEST_F(Server, StreamsAreFew) {
  limits_.streams = 1;
  start();
  RawClient first(where_);
  first.send(testing::request_text("GET", "/events"));
  first.receive_until("first");
  EXPECT_EQ(testing::get(where_, "/events").status, 503);
  EXPECT_EQ(get_text("/a"), "GET /a ");
}

TEST_F(Server, EndsWithStreamsAndAnswersUnderWay) {
  start();
  RawClient stream(where_);
  stream.send(testing::request_text("GET", "/events"));
  stream.receive_until("first");
  RawClient slow(where_);
  slow.send(testing::request_text("GET", "/slow"));
  while (echo_.answered < 2) std::this_thread::sleep_for(1ms);
  const auto begin = Clock::now();
  server_.reset();
  EXPECT_LT(Clock::now() - begin, 3s);
  EXPECT_TRUE(stream.closed());
  echo_.events->push(std::make_shared<const std::string>("nobody listens"));
}

TEST_F(Server, OnlyLoopbackIsListenedOn) {
  EXPECT_FALSE(HttpServer::start({std::nullopt, "0.0.0.0:0"}, limits_, echo_).has_value());
  EXPECT_FALSE(HttpServer::start({}, limits_, echo_).has_value());
  const auto first = HttpServer::start({std::nullopt, "127.0.0.1:0"}, limits_, echo_);
  ASSERT_TRUE(first.has_value());
  const auto taken = HttpServer::start(
      {std::nullopt, "127.0.0.1:" + std::to_string((*first)->port())}, limits_, echo_);
  ASSERT_FALSE(taken.has_value());
  EXPECT_NE(taken.error().message.find("in use"), std::string::npos) << taken.error().message;
}

}  // namespace
}  // namespace imunoise::service
