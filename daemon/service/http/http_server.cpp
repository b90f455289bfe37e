#include "daemon/service/http/http_server.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <set>
#include <thread>
#include <utility>

#include "daemon/service/http/http_connection.h"
#include "daemon/service/http/listen_address.h"
#include "daemon/service/http/peer_owner.h"
#include "daemon/service/http/unix_socket.h"

namespace imunoise::service {
namespace {

constexpr std::chrono::milliseconds kAcceptPause{100};  // without a file descriptor to spare

// TCP on loopback comes from this machine too: its kernel knows from whom.
Peer peer_on(Stream::socket_type& socket, bool local) {
  if (local) return {true, peer_of(socket.native_handle())};
  const auto owner = owner_of_peer(socket.native_handle());
  return {false, owner ? fmt::format("uid {} by TCP", *owner) : "loopback"};
}

// Asio does not. Until then a child may be begun: Spawning closes what it inherits.
void keep_from_children(int socket) { ::fcntl(socket, F_SETFD, FD_CLOEXEC); }

}  // namespace

class HttpServer::Implementation {
 public:
  Implementation(const HttpLimits& limits, Handler& handler)
      : shared_(limits, handler), guard_(shared_.io.get_executor()) {}

  ~Implementation() {
    asio::post(shared_.io, [this] {
      ending_ = true;
      if (local_) local_->acceptor.close();
      if (tcp_) tcp_->acceptor.close();
      const auto open = connections_;
      for (const auto& one : open) one->finish();
    });
    shared_.waiting.join();
    shared_.prompt.join();
    guard_.reset();
    if (thread_.joinable()) thread_.join();
    std::error_code ignored;
    if (local_) std::filesystem::remove(socket_, ignored);
  }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  Result<void> listen(const Listen& where) {
    if (!where.socket && !where.address) return fail("no address to serve the API on");
    if (where.socket) {
      auto descriptor = listen_on(*where.socket);
      if (!descriptor) return tl::unexpected(descriptor.error());
      socket_ = *where.socket;
      local_.emplace(shared_.io);
      local_->acceptor.assign(asio::local::stream_protocol(), *descriptor);
    }
    return where.address ? listen_tcp(*where.address) : Result<void>();
  }

  void run() {
    if (local_) accept(*local_);
    if (tcp_) accept(*tcp_);
    thread_ = std::thread([this] { shared_.io.run(); });
  }

  std::uint16_t port() const { return port_; }
  const Counts& counts() const { return shared_.counts; }

 private:
  template <class Protocol>
  struct Door {
    explicit Door(asio::io_context& io) : acceptor(io), pause(io) {}
    typename Protocol::acceptor acceptor;
    asio::steady_timer pause;
    static constexpr bool kLocal = std::is_same_v<Protocol, asio::local::stream_protocol>;
  };

  Result<void> listen_tcp(const std::string& text) {
    const auto address = parse_listen(text);
    if (!address) return tl::unexpected(address.error());
    const asio::ip::address host = address->six
                                       ? asio::ip::address(asio::ip::address_v6::loopback())
                                       : asio::ip::address_v4::loopback();
    const asio::ip::tcp::endpoint endpoint(host, address->port);
    tcp_.emplace(shared_.io);
    auto& door = tcp_->acceptor;
    error_code error;
    door.open(endpoint.protocol(), error);
    if (!error) keep_from_children(door.native_handle());
    if (!error) door.set_option(asio::socket_base::reuse_address(true), error);
    if (!error) door.bind(endpoint, error);
    if (!error) door.listen(asio::socket_base::max_listen_connections, error);
    if (error) return fail(fmt::format("{}: cannot be listened on: {}", text, error.message()));
    port_ = door.local_endpoint().port();
    return {};
  }

  template <class Door>
  void accept(Door& door) {
    auto next = std::make_shared<Connection>(
        shared_, [this](const std::shared_ptr<Connection>& gone) { forget(gone); });
    door.acceptor.async_accept(next->socket(), [this, &door, next](const error_code& error) {
      if (ending_ || error == asio::error::operation_aborted) return;
      if (!error) {
        take(next, Door::kLocal);
        return accept(door);
      }
      door.pause.expires_after(kAcceptPause);
      door.pause.async_wait([this, &door](const error_code&) {
        if (!ending_) accept(door);
      });
    });
  }

  void take(const std::shared_ptr<Connection>& next, bool local) {
    ++shared_.counts.accepted;
    keep_from_children(next->socket().native_handle());
    Peer peer = peer_on(next->socket(), local);
    make_room(peer);
    std::size_t& same = shared_.of_peer[peer.name];
    if (connections_.size() >= shared_.limits.connections ||
        same >= shared_.limits.connections_of_peer) {
      ++shared_.counts.turned_away;
      return next->turn_away();
    }
    ++same;
    connections_.insert(next);
    shared_.counts.connections = connections_.size();
    next->begin(std::move(peer));
  }

  // Those that were there first and do nothing go first. Strangers make room for each other only
  // among themselves, and for everybody else.
  void make_room(const Peer& peer) {
    const auto of_peer = [&](const Connection& one) { return one.peer().name == peer.name; };
    const auto stranger = [](const Connection& one) { return one.stranger(); };
    const auto strangers = std::count_if(connections_.begin(), connections_.end(),
                                         [](const auto& one) { return one->stranger(); });
    const auto same = shared_.of_peer.find(peer.name);
    if (!peer.local && strangers >= static_cast<std::ptrdiff_t>(shared_.limits.strangers)) {
      if (!evict([&](const auto& one) { return stranger(one) && of_peer(one); })) evict(stranger);
    } else if (same != shared_.of_peer.end() &&
               same->second >= shared_.limits.connections_of_peer) {
      evict([&](const auto& one) { return (stranger(one) || one.idle()) && of_peer(one); });
    } else if (connections_.size() >= shared_.limits.connections) {
      if (!evict(stranger)) evict([](const auto& one) { return one.idle(); });
    }
  }

  // The one of these whose turn was the longest ago; false where there is none.
  template <class Which>
  bool evict(const Which& which) {
    std::shared_ptr<Connection> oldest;
    for (const auto& one : connections_) {
      if (which(*one) && (!oldest || one->turn() < oldest->turn())) oldest = one;
    }
    if (!oldest) return false;
    ++shared_.counts.evicted;
    oldest->finish();
    return true;
  }

  void forget(const std::shared_ptr<Connection>& gone) {
    const auto same = shared_.of_peer.find(gone->peer().name);
    if (--same->second == 0) shared_.of_peer.erase(same);
    connections_.erase(gone);
    shared_.counts.connections = connections_.size();
  }

  Shared shared_;
  asio::executor_work_guard<asio::io_context::executor_type> guard_;
  std::optional<Door<asio::local::stream_protocol>> local_;
  std::optional<Door<asio::ip::tcp>> tcp_;
  std::filesystem::path socket_;
  std::uint16_t port_ = 0;
  // Of the network's thread:
  std::set<std::shared_ptr<Connection>> connections_;
  bool ending_ = false;
  std::thread thread_;
};

HttpServer::HttpServer(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
HttpServer::~HttpServer() = default;

Result<std::unique_ptr<HttpServer>> HttpServer::start(const Listen& listen,
                                                      const HttpLimits& limits, Handler& handler) {
  try {
    auto out = std::make_unique<Implementation>(limits, handler);
    if (auto done = out->listen(listen); !done) return tl::unexpected(done.error());
    out->run();
    return std::unique_ptr<HttpServer>(new HttpServer(std::move(out)));
  } catch (const std::exception& error) {
    return fail(fmt::format("the service cannot listen: {}", error.what()));
  }
}

HttpCounters HttpServer::counters() const {
  const Counts& now = implementation_->counts();
  return {now.connections, now.streams,   now.accepted,  now.turned_away,
          now.evicted,     now.timed_out, now.malformed, now.streams_dropped};
}

std::uint16_t HttpServer::port() const { return implementation_->port(); }

}  // namespace imunoise::service
