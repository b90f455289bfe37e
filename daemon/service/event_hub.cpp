#include "daemon/service/event_hub.h"

#include <fmt/format.h>

#include <algorithm>

#include "daemon/service/api/json.h"

namespace imunoise::service {
namespace {

constexpr std::size_t kMostEvents = 256;
constexpr std::size_t kMostBytes = std::size_t{1} << 20U;

const std::string& topic_of(const v1::Event& event) {
  return v1::Event::descriptor()->FindFieldByNumber(event.what_case())->name();
}

// In the field that is set alone: the name of the event says which.
const google::protobuf::Message& content(const v1::Event& event) {
  return event.GetReflection()->GetMessage(
      event, v1::Event::descriptor()->FindFieldByNumber(event.what_case()));
}

Result<void> check(const std::vector<std::string>& topics) {
  std::string known;
  for (int i = 0; i < v1::Event::descriptor()->field_count(); ++i) {
    known += (i == 0 ? "" : ", ") + v1::Event::descriptor()->field(i)->name();
  }
  for (const std::string& topic : topics) {
    if (v1::Event::descriptor()->FindFieldByName(topic) == nullptr)
      return fail(fmt::format("topic '{}': there are {}", topic, known));
  }
  return {};
}

}  // namespace

bool EventHub::Listener::wants(const std::string& topic) const {
  return topics.empty() || std::find(topics.begin(), topics.end(), topic) != topics.end();
}

EventHub::~EventHub() {
  for (const Listener& one : listeners_) one.queue->close();
}

void EventHub::push(const Listener& listener, const v1::Event& event,
                    std::shared_ptr<const std::string>& text) {
  const std::string& topic = topic_of(event);
  if (!listener.wants(topic)) return;
  if (!text) text = std::make_shared<const std::string>(event_text(topic, content(event)));
  listener.queue->push(text);
}

Result<std::shared_ptr<EventQueue>> EventHub::subscribe(
    const std::vector<std::string>& topics, const std::function<std::vector<v1::Event>()>& now) {
  if (auto known = check(topics); !known) return tl::unexpected(known.error());
  Listener one{topics, std::make_shared<EventQueue>(kMostEvents, kMostBytes)};
  const std::lock_guard lock(mutex_);
  for (const v1::Event& event : now()) {
    std::shared_ptr<const std::string> text;
    push(one, event, text);
  }
  listeners_.push_back(one);
  return one.queue;
}

void EventHub::tell(const v1::Event& event) {
  const std::lock_guard lock(mutex_);
  std::erase_if(listeners_, [](const Listener& one) { return !one.queue->open(); });
  std::shared_ptr<const std::string> text;
  for (const Listener& one : listeners_) push(one, event, text);
}

bool EventHub::wanted(const std::string& topic) const {
  const std::lock_guard lock(mutex_);
  return std::any_of(listeners_.begin(), listeners_.end(),
                     [&](const Listener& one) { return one.queue->open() && one.wants(topic); });
}

}  // namespace imunoise::service
