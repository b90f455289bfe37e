// The server against requests that are too large, or are none, and others on its socket.

#include <fcntl.h>
#include <sys/stat.h>

#include <fstream>

#include "daemon/service/http/unix_socket.h"
#include "tests/daemon/service/echo_server.h"

namespace imunoise::service {
namespace {

using namespace std::chrono_literals;
using testing::RawClient;
using testing::Where;
using Clock = std::chrono::steady_clock;

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

}  // namespace
}  // namespace imunoise::service
