#pragma once

// What systemd is told, where it started the daemon; else nothing happens.

#include <chrono>
#include <optional>
#include <string>

namespace imunoise::app {

class ServiceManager {
 public:
  ServiceManager();

  void ready() const;
  /// One line for people: systemctl status shows it.
  void status(const std::string& text) const;
  void stopping() const;
  /// To be called often: says that the daemon lives, twice in the time that systemd allows.
  void alive();

 private:
  std::optional<std::chrono::microseconds> every_;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace imunoise::app
