#include "daemon/service/http/event_queue.h"

#include <utility>

namespace imunoise::service {

void EventQueue::push(std::shared_ptr<const std::string> text) {
  const std::lock_guard lock(mutex_);
  if (ended_) return;
  if (waiting_.size() == most_ || bytes_ + text->size() > most_bytes_) {
    overflow_ = true;
    end();
  } else {
    bytes_ += text->size();
    waiting_.push_back(std::move(text));
  }
  if (wake_) wake_();
}

void EventQueue::end() {
  ended_ = true;
  waiting_.clear();
  bytes_ = 0;
}

void EventQueue::close() {
  const std::lock_guard lock(mutex_);
  end();
  wake_ = nullptr;
}

bool EventQueue::open() const {
  const std::lock_guard lock(mutex_);
  return !ended_;
}

void EventQueue::on_news(std::function<void()> wake) {
  const std::lock_guard lock(mutex_);
  wake_ = std::move(wake);
}

EventQueue::Taken EventQueue::take() {
  const std::lock_guard lock(mutex_);
  Taken out{{}, ended_, overflow_};
  for (const auto& one : waiting_) out.text += *one;
  waiting_.clear();
  bytes_ = 0;
  return out;
}

}  // namespace imunoise::service
