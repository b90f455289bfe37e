#pragma once

// One connection of the server. Only http_server.cpp includes it.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/basic_stream.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "daemon/service/http/http_server.h"

namespace imunoise::service {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using boost::system::error_code;
using Stream = beast::basic_stream<asio::generic::stream_protocol>;

inline constexpr std::chrono::seconds kLinger{2};  // after a response that ends a connection
inline constexpr std::size_t kLingerBytes = std::size_t{1}
                                            << 18U;  // what is then read and thrown away

struct Counts {
  std::atomic<std::uint64_t> connections = 0, streams = 0, accepted = 0, turned_away = 0,
                             evicted = 0, timed_out = 0, malformed = 0, streams_dropped = 0;
};

// What connections share. `connections` belongs to the network's thread.
struct Shared {
  Shared(const HttpLimits& limits_, Handler& handler_)
      : limits(limits_),
        handler(handler_),
        waiting(limits_.waiting_threads),
        prompt(limits_.prompt_threads) {}

  const HttpLimits limits;
  Handler& handler;
  asio::io_context io{1};
  // These make answers: a disk that hangs may hold up all of the first.
  asio::thread_pool waiting;
  asio::thread_pool prompt;
  Counts counts;
  std::map<std::string, std::size_t> of_peer;
  std::uint64_t turns = 0;  // connections that began, and responses that ended
};

class Connection : public std::enable_shared_from_this<Connection> {
 public:
  using Gone = std::function<void(const std::shared_ptr<Connection>&)>;

  Connection(Shared& shared, Gone gone)
      : shared_(shared), gone_(std::move(gone)), stream_(shared.io), heartbeat_(shared.io) {}

  auto& socket() { return stream_.socket(); }
  const Peer& peer() const { return peer_; }

  void begin(Peer peer) {
    peer_ = std::move(peer);
    known_ = peer_.local;  // the file's permissions have let it in
    read_head();
  }

  // It has not shown who it is.
  bool stranger() const { return !known_; }
  // It waits for another request, or its last response has been sent.
  bool idle() const { return !busy_ && !first_; }
  // Greater for those that began, or were answered, later.
  std::uint64_t turn() const { return turn_; }

  // Says why nothing more will come, without waiting, and closes.
  void turn_away() {
    const Response why = shared_.handler.trouble(503, "too many connections; try again later");
    const std::string text = fmt::format(
        "HTTP/1.1 503 Service Unavailable\r\nContent-Type: {}\r\nContent-Length: "
        "{}\r\nRetry-After: "
        "1\r\nConnection: close\r\n\r\n{}",
        why.content_type, why.body.size(), why.body);
    error_code ignored;
    socket().non_blocking(true, ignored);
    socket().write_some(asio::buffer(text), ignored);
    socket().shutdown(asio::socket_base::shutdown_send, ignored);
  }

  void finish() {
    if (finished_) return;
    finished_ = true;
    heartbeat_.cancel();
    if (events_) {
      events_->close();
      --shared_.counts.streams;
    }
    stream_.close();
    gone_(shared_from_this());
  }

 private:
  // A continuation that keeps this alive.
  template <class Next>
  auto then(Next next) {
    return [self = shared_from_this(), next](const error_code& error, std::size_t bytes) {
      if (!self->finished_) next(*self, error, bytes);
    };
  }

  void read_head() {
    busy_ = false;
    turn_ = ++shared_.turns;
    parser_.emplace();
    parser_->header_limit(static_cast<std::uint32_t>(shared_.limits.header_bytes));
    parser_->body_limit(shared_.limits.body_bytes);
    const auto& limits = shared_.limits;  // of the head and the body together
    stream_.expires_after(first_ ? std::min(limits.first_head, limits.request) : limits.request);
    http::async_read_header(stream_, buffer_, *parser_,
                            then([](Connection& self, const error_code& error, std::size_t) {
                              if (error) return self.refuse_unread(error);
                              self.take_head();
                            }));
  }

  void refuse_unread(const error_code& error) {
    const auto refuse = [&](unsigned status, const char* sentence) {
      ++shared_.counts.malformed;
      send(shared_.handler.trouble(status, sentence), false);
    };
    if (error == beast::error::timeout) {
      ++shared_.counts.timed_out;
      finish();
    } else if (error == http::error::body_limit) {
      refuse(413, "the body is too large");
    } else if (error == http::error::header_limit || error == http::error::buffer_overflow) {
      refuse(431, "the header is too large");
    } else if (error == http::error::end_of_stream || error == http::error::partial_message ||
               error.category() != make_error_code(http::error::bad_method).category()) {
      finish();  // it has gone
    } else {
      refuse(400, "this is not an HTTP/1.1 request");
    }
  }

  void take_head() {
    const auto& fields = parser_->get();
    for (const http::field one :
         {http::field::host, http::field::origin, http::field::authorization,
          http::field::content_type, http::field::cookie}) {
      if (fields.count(one) > 1) {
        ++shared_.counts.malformed;
        return send(shared_.handler.trouble(400, "a header comes twice"), false);
      }
    }
    const auto text = [&](http::field name) { return std::string(fields[name]); };
    request_ = {};
    request_.method = std::string(fields.method_string());
    request_.target = std::string(fields.target());
    request_.host = text(http::field::host);
    request_.origin = text(http::field::origin);
    request_.authorization = text(http::field::authorization);
    request_.content_type = text(http::field::content_type);
    request_.cookie = text(http::field::cookie);
    request_.accept_encoding = text(http::field::accept_encoding);
    request_.if_none_match = text(http::field::if_none_match);
    request_.peer = peer_;
    known_ = known_ || shared_.handler.knows(request_);
    if (std::exchange(first_, false)) stream_.expires_after(shared_.limits.request);
    if (auto refusal = shared_.handler.refuse(request_)) return send(std::move(*refusal), false);
    busy_ = true;
    http::async_read(stream_, buffer_, *parser_,
                     then([](Connection& self, const error_code& error, std::size_t) {
                       if (error) return self.refuse_unread(error);
                       self.answer();
                     }));
  }

  void answer() {
    stream_.expires_never();
    request_.body = std::move(parser_->get().body());
    asio::thread_pool& pool = shared_.handler.waits(request_) ? shared_.waiting : shared_.prompt;
    asio::post(pool, [self = shared_from_this()] {
      auto response = std::make_shared<Response>(self->shared_.handler.answer(self->request_));
      asio::post(self->shared_.io, [self, response] {
        if (self->finished_) {
          if (response->events) response->events->close();
        } else if (response->events) {
          self->send_events(*response);
        } else {
          self->send(std::move(*response), self->parser_->get().keep_alive());
        }
      });
    });
  }

  void send(Response response, bool keep_alive) {
    response_ = {};
    response_.version(11);
    response_.result(response.status);
    response_.set(http::field::content_type, response.content_type);
    response_.set(http::field::cache_control, "no-store");
    response_.set("X-Content-Type-Options", "nosniff");
    for (const auto& [name, value] : response.headers) response_.set(name, value);
    response_.keep_alive(keep_alive);
    response_.body() = std::move(response.body);
    response_.prepare_payload();
    stream_.expires_after(shared_.limits.response);
    http::async_write(stream_, response_,
                      then([](Connection& self, const error_code& error, std::size_t) {
                        if (error) return self.lose(error);
                        if (self.response_.keep_alive()) return self.read_head();
                        self.linger();
                      }));
  }

  void lose(const error_code& error) {
    if (error == beast::error::timeout) ++shared_.counts.timed_out;
    finish();
  }

  // What the other side still sends is thrown away for a while: closing at once would throw the
  // response away where it was not read yet.
  void linger() {
    error_code error;
    socket().shutdown(asio::socket_base::shutdown_send, error);
    if (error) return finish();
    busy_ = false;
    stream_.expires_after(kLinger);
    discard();
  }
  void discard() {
    stream_.async_read_some(asio::buffer(scratch_),
                            then([](Connection& self, const error_code& error, std::size_t bytes) {
                              self.discarded_ += bytes;
                              if (error || self.discarded_ > kLingerBytes) return self.finish();
                              self.discard();
                            }));
  }

  void send_events(const Response& response) {
    if (shared_.counts.streams >= shared_.limits.streams) {
      response.events->close();
      return send(shared_.handler.trouble(503, "too many streams of events; try again later"),
                  false);
    }
    ++shared_.counts.streams;
    events_ = response.events;
    events_->on_news([weak = weak_from_this(), &io = shared_.io, told = told_] {
      if (told->exchange(true)) return;
      asio::post(io, [weak] {
        if (const auto self = weak.lock()) self->take_events();
      });
    });
    stream_.expires_never();
    stream_.async_read_some(  // whatever comes, or its end, ends the stream
        asio::buffer(scratch_),
        then([](Connection& self, const error_code&, std::size_t) { self.finish(); }));
    write(
        fmt::format("HTTP/1.1 200 OK\r\nContent-Type: {}\r\nCache-Control: no-store\r\n"
                    "X-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n",
                    response.content_type));
  }

  void write(std::string text) {
    writing_ = true;
    outgoing_ = std::move(text);
    stream_.expires_after(shared_.limits.response);  // of the writing: the reading is under way
    asio::async_write(stream_, asio::buffer(outgoing_),
                      then([](Connection& self, const error_code& error, std::size_t) {
                        self.writing_ = false;
                        if (error) return self.lose(error);
                        self.take_events();
                      }));
  }

  void take_events() {
    if (finished_) return;
    *told_ = false;
    if (writing_ && events_->open()) return;
    EventQueue::Taken taken = events_->take();
    if (taken.ended) {
      if (taken.overflow) ++shared_.counts.streams_dropped;
      return finish();
    }
    if (!taken.text.empty()) return write(std::move(taken.text));
    heartbeat_.expires_after(shared_.limits.heartbeat);
    heartbeat_.async_wait([self = shared_from_this()](const error_code& error) {
      if (!error && !self->finished_ && !self->writing_) self->write(": \n\n");
    });
  }

  Shared& shared_;
  Gone gone_;
  Stream stream_;
  asio::steady_timer heartbeat_;
  Peer peer_;
  beast::flat_buffer buffer_{std::size_t{1} << 17U};
  std::optional<http::request_parser<http::string_body>> parser_;
  Request request_;
  http::response<http::string_body> response_;
  std::shared_ptr<EventQueue> events_;
  std::shared_ptr<std::atomic<bool>> told_ = std::make_shared<std::atomic<bool>>(false);
  std::string outgoing_;
  std::array<char, 4096> scratch_{};
  std::size_t discarded_ = 0;
  bool known_ = false;
  bool first_ = true;  // no head of a request has come yet
  bool busy_ = false;  // from a request's head to the end of its response
  std::uint64_t turn_ = 0;
  bool writing_ = false;
  bool finished_ = false;
};

}  // namespace imunoise::service
