#pragma once

// Events on their way to one reader. Senders never wait for it.

#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace imunoise::service {

/// Thread-safe.
class EventQueue {
 public:
  /// At most so many events, and so many bytes, may wait.
  EventQueue(std::size_t events, std::size_t bytes) : most_(events), most_bytes_(bytes) {}

  /// Adds an event. What finds no room ends the queue: its reader is too slow, and what it missed
  /// would be missing without a sign.
  void push(std::shared_ptr<const std::string> text);
  /// The reader has gone, or is to go.
  void close();
  /// Something may be pushed still.
  bool open() const;

  /// `wake` is called, from any thread, when something has come or the queue has ended. It must
  /// not use the queue. close() forgets it: afterwards it is not running.
  void on_news(std::function<void()> wake);

  struct Taken {
    std::string text;       ///< All events that waited, one after the other.
    bool ended = false;     ///< Nothing will come any more.
    bool overflow = false;  ///< Because it found no room.
  };
  Taken take();

 private:
  void end();

  const std::size_t most_;
  const std::size_t most_bytes_;
  mutable std::mutex mutex_;
  std::vector<std::shared_ptr<const std::string>> waiting_;
  std::size_t bytes_ = 0;
  bool ended_ = false;
  bool overflow_ = false;
  std::function<void()> wake_;
};

}  // namespace imunoise::service
