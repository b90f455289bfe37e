// The server against clients that are too slow, too large or too many.

#include "daemon/service/http_server.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <atomic>
#include <fstream>
#include <thread>

#include "daemon/service/peer_owner.h"
#include "daemon/service/unix_socket.h"
#include "tests/daemon/service/raw_client.h"
#include "tests/study/simulated_recording.h"

namespace imunoise::service {
namespace {

using namespace std::chrono_literals;
using testing::RawClient;
using testing::RawResponse;
using testing::Where;
using Clock = std::chrono::steady_clock;

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
    if (request.target == "/slow") std::this_thread::sleep_for(300ms);
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
    const auto deadline = Clock::now() + 5s;
    while (server_->counters().*counter != value) {
      if (Clock::now() > deadline) return false;
      std::this_thread::sleep_for(5ms);
    }
    return true;
  }

  const testing::TemporaryFolder folder_;
  Where where_{folder_.path() / "api.sock", 0};
  HttpLimits limits_;
  Echo echo_;
  std::unique_ptr<HttpServer> server_;
};

TEST_F(Server, AnswersSeveralRequestsOfOneConnection) {
  start();
  RawClient client(where_);
  for (const char* const path : {"/a", "/b", "/c"}) {
    client.send(testing::request_text("POST", path, {}, "body"));
    EXPECT_EQ(client.receive().body, std::string("POST ") + path + " body");
  }
  client.send(testing::request_text("GET", "/d", {"Connection: close"}));
  EXPECT_EQ(client.receive().body, "GET /d ");
  EXPECT_TRUE(client.closed());
  EXPECT_EQ(server_->counters().accepted, 1U);
}

TEST_F(Server, ADiskThatHangsHoldsUpNoOtherRequest) {
  start();
  std::vector<std::unique_ptr<RawClient>> held;
  for (std::size_t i = 0; i < 2 * limits_.waiting_threads; ++i) {
    held.push_back(std::make_unique<RawClient>(where_));
    held.back()->send(testing::request_text("GET", "/hanging"));
  }
  const auto deadline = Clock::now() + 5s;
  while (echo_.answered < static_cast<int>(limits_.waiting_threads) && Clock::now() < deadline)
    std::this_thread::sleep_for(1ms);
  EXPECT_EQ(get_text("/healthz"), "GET /healthz ");
  echo_.let_go = true;
  echo_.let_go.notify_all();
  for (const auto& one : held) EXPECT_EQ(one->receive().status, 200);
}

TEST_F(Server, TakesChunkedBodies) {
  start();
  RawClient client(where_);
  client.send(
      "POST / HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: "
      "chunked\r\n\r\n3\r\nabc\r\n2\r\nde\r\n0\r\n\r\n");
  EXPECT_EQ(client.receive().body, "POST / abcde");
}

TEST_F(Server, TheSocketIsForOwnerAndGroup) {
  start();
  struct stat found {};
  ASSERT_EQ(::stat(where_.socket.c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 07777U, 0660U);
  server_.reset();
  EXPECT_FALSE(std::filesystem::exists(where_.socket));
}

// A child that kept one would keep the port, or the connection, when we have gone.
TEST_F(Server, ChildrenInheritNoSocket) {
  auto server = HttpServer::start({where_.socket, "127.0.0.1:0"}, limits_, echo_);
  ASSERT_TRUE(server.has_value());
  server_ = std::move(*server);
  std::vector<RawClient> clients;
  for (const Where& where : {where_, Where{"", server_->port()}}) {
    clients.emplace_back(where).send(testing::request_text("GET", "/a"));
    EXPECT_EQ(clients.back().receive().status, 200);
  }
  int sockets = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    const int one = std::stoi(entry.path().filename());
    std::error_code gone;  // the server may close one meanwhile
    if (!std::filesystem::read_symlink(entry.path(), gone).string().starts_with("socket:"))
      continue;
    ++sockets;
    EXPECT_NE(::fcntl(one, F_GETFD) & FD_CLOEXEC, 0) << one;
  }
  EXPECT_GE(sockets, 6) << "two that listen, and both ends of two connections";
}

TEST_F(Server, TakesOverASocketThatADeadProcessLeft) {
  ::close(listen_on(where_.socket).value());
  ASSERT_TRUE(std::filesystem::exists(where_.socket));
  start();
  EXPECT_EQ(get_text(), "GET / ");
}

TEST_F(Server, TakesNoFileFromOthers) {
  start();
  auto second = HttpServer::start({where_.socket, std::nullopt}, limits_, echo_);
  ASSERT_FALSE(second.has_value());
  EXPECT_NE(second.error().message.find("another process uses it"), std::string::npos);
  EXPECT_EQ(get_text(), "GET / ") << "the first one goes on";
  server_.reset();
  std::filesystem::create_symlink(folder_.path() / "elsewhere", where_.socket);
  EXPECT_FALSE(HttpServer::start({where_.socket, std::nullopt}, limits_, echo_).has_value());
  std::filesystem::remove(where_.socket);
  std::ofstream(where_.socket) << "precious";
  EXPECT_FALSE(HttpServer::start({where_.socket, std::nullopt}, limits_, echo_).has_value());
  std::ifstream kept(where_.socket);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(kept), {}), "precious");
  const std::string long_name(120, 'x');
  EXPECT_FALSE(
      HttpServer::start({folder_.path() / long_name, std::nullopt}, limits_, echo_).has_value());
}

TEST_F(Server, TooLargeBodiesAreNotRead) {
  limits_.body_bytes = 1000;
  start();
  for (const char* const head : {"Content-Length: 1073741824\r\n", "Content-Length: 1001\r\n"}) {
    RawClient client(where_);
    client.send(std::string("POST / HTTP/1.1\r\nHost: x\r\n") + head + "\r\n");
    EXPECT_EQ(client.receive().status, 413) << head;
  }
  EXPECT_EQ(
      testing::send_one(where_, testing::request_text("POST", "/", {}, std::string(1000, 'x')))
          .status,
      200);
  EXPECT_EQ(echo_.answered, 1);
}

TEST_F(Server, AFloodOfChunksIsCut) {
  limits_.body_bytes = 10'000;
  start();
  RawClient client(where_);
  client.send("POST / HTTP/1.1\r\nHost: x\r\nTransfer-Encoding: chunked\r\n\r\n");
  const std::string chunk = "10000\r\n" + std::string(65536, 'x') + "\r\n";
  std::size_t sent = 0;
  while (sent < (std::size_t{1} << 30U) && client.send(chunk)) sent += chunk.size();
  EXPECT_LT(sent, std::size_t{8} << 20U) << "of the 1 GiB it would have sent";
  EXPECT_EQ(echo_.answered, 0);
  EXPECT_TRUE(comes(&HttpCounters::connections, 0));
}

TEST_F(Server, TooLargeHeadsAreRefused) {
  start();
  RawClient client(where_);
  client.send("GET / HTTP/1.1\r\nHost: x\r\nX: " + std::string(20'000, 'x') + "\r\n\r\n");
  EXPECT_EQ(client.receive().status, 431);
  EXPECT_EQ(echo_.answered, 0);
}

TEST_F(Server, WhatIsNoHttpIsRefused) {
  start();
  for (const char* const text :
       {"hello\r\n\r\n", "GET /\r\n\r\n", "GET / HTTP/2.0\r\n\r\n",
        "GET / HTTP/1.1\r\nHost x\r\n\r\n",
        "POST / HTTP/1.1\r\nHost: x\r\nContent-Length: -1\r\n\r\n",
        "POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 5\r\nTransfer-Encoding: chunked\r\n\r\n",
        "POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 5\r\nContent-Length: 6\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: x\r\nHost: y\r\n\r\n"}) {
    RawClient client(where_);
    client.send(text);
    EXPECT_EQ(client.receive().status, 400) << text;
    EXPECT_TRUE(client.closed()) << text;
  }
  EXPECT_EQ(echo_.answered, 0);
  EXPECT_EQ(server_->counters().malformed, 8U);
}

TEST_F(Server, ARefusedRequestIsClosedWithItsBodyUnread) {
  start();
  RawClient client(where_);
  client.send("POST /refused HTTP/1.1\r\nHost: x\r\nContent-Length: 1000000\r\n\r\nabc");
  EXPECT_EQ(client.receive().status, 403);
  EXPECT_TRUE(client.closed());
  EXPECT_EQ(echo_.answered, 0);
}

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
