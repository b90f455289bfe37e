#pragma once

#include <array>
#include <csignal>

namespace imunoise::process {

/// For programs that record. While it lives, SIGPIPE (a log or a pipe whose reader has gone),
/// SIGUSR1 and SIGUSR2, which mean nothing here, do not end the program: they would leave a
/// recording open. Children begin with the defaults (Spawning).
class IgnoredSignals {
 public:
  static constexpr std::array<int, 3> kSignals = {SIGPIPE, SIGUSR1, SIGUSR2};

  IgnoredSignals();
  ~IgnoredSignals();
  IgnoredSignals(const IgnoredSignals&) = delete;
  IgnoredSignals& operator=(const IgnoredSignals&) = delete;

 private:
  std::array<struct sigaction, kSignals.size()> before_{};
};

}  // namespace imunoise::process
