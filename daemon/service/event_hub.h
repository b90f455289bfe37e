#pragma once

// Sends every change to its listeners.

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "daemon/service/http/event_queue.h"
#include "imunoise/v1/service.pb.h"

namespace imunoise::service {

/// Thread-safe. Senders never wait for listeners.
class EventHub {
 public:
  EventHub() = default;
  ~EventHub();
  EventHub(const EventHub&) = delete;
  EventHub& operator=(const EventHub&) = delete;

  /// A new listener to some topics (names of v1::Event's fields; none: all): first what `now` says,
  /// then everything that is told after it. Error: there is no such topic.
  Result<std::shared_ptr<EventQueue>> subscribe(const std::vector<std::string>& topics,
                                                const std::function<std::vector<v1::Event>()>& now);
  void tell(const v1::Event& event);
  /// Whether a topic has a listener.
  bool wanted(const std::string& topic) const;

 private:
  struct Listener {
    std::vector<std::string> topics;
    std::shared_ptr<EventQueue> queue;
    bool wants(const std::string& topic) const;
  };
  static void push(const Listener& listener, const v1::Event& event,
                   std::shared_ptr<const std::string>& text);

  mutable std::mutex mutex_;
  std::vector<Listener> listeners_;
};

}  // namespace imunoise::service
