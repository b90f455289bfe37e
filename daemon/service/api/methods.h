#pragma once

// What the methods of the API do.

#include <google/protobuf/message.h>

#include <functional>
#include <map>
#include <memory>
#include <utility>

#include "daemon/service/api/answer.h"
#include "daemon/service/http/event_queue.h"

namespace imunoise::service {

/// A message, or a stream of events.
struct Reply {
  std::unique_ptr<google::protobuf::Message> message;
  std::shared_ptr<EventQueue> events;
};

/// Functions by the type of their request, of which each method has its own. Thread-safe once all
/// are there.
class Methods {
 public:
  /// `function` takes a Request and returns an Answer of a message, or of an EventQueue. It waits
  /// for no disk and no computation.
  template <class Request, class Function>
  void on(Function function) {
    add<Request>(std::move(function), false);
  }
  /// The same for one that may wait.
  template <class Request, class Function>
  void on_waiting(Function function) {
    add<Request>(std::move(function), true);
  }

  bool has(const google::protobuf::Descriptor* request) const {
    return functions_.contains(request);
  }
  /// Precondition: has() it.
  bool waits(const google::protobuf::Descriptor* request) const {
    return functions_.at(request).waits;
  }
  /// Precondition: has() its type.
  Answer<Reply> call(const google::protobuf::Message& request) const {
    return functions_.at(request.GetDescriptor()).call(request);
  }

 private:
  struct Entry {
    std::function<Answer<Reply>(const google::protobuf::Message&)> call;
    bool waits = false;
  };
  template <class Request, class Function>
  void add(Function function, bool waits) {
    functions_[Request::descriptor()] = {
        [function = std::move(function)](const google::protobuf::Message& request) {
          return reply(function(static_cast<const Request&>(request)));
        },
        waits};
  }
  static Answer<Reply> reply(Answer<std::shared_ptr<EventQueue>> events) {
    if (!events) return tl::unexpected(std::move(events.error()));
    return Reply{nullptr, std::move(*events)};
  }
  template <class Message>
  static Answer<Reply> reply(Answer<Message> message) {
    if (!message) return tl::unexpected(std::move(message.error()));
    return Reply{std::make_unique<Message>(std::move(*message)), nullptr};
  }

  std::map<const google::protobuf::Descriptor*, Entry> functions_;
};

}  // namespace imunoise::service
