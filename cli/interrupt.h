#pragma once

#include <csignal>
#include <stop_token>
#include <thread>

namespace imunoise::cli {

/// While it lives, SIGINT, SIGTERM and SIGHUP (a terminal that was lost, unless nohup says that it
/// does not matter) ask for an orderly end instead of killing the program. Made before other
/// threads are: they inherit that these signals are not theirs.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  /// Requested by the first signal.
  std::stop_token token() const { return source_.get_token(); }

 private:
  sigset_t before_{};
  std::stop_source source_;
  std::jthread watcher_;
};

}  // namespace imunoise::cli
