#include "daemon/app/service_manager.h"

#include <systemd/sd-daemon.h>

namespace imunoise::app {

ServiceManager::ServiceManager() {
  std::uint64_t allowed_us = 0;
  if (sd_watchdog_enabled(0, &allowed_us) > 0) every_ = std::chrono::microseconds(allowed_us / 2);
}

void ServiceManager::ready() const { sd_notify(0, "READY=1"); }

void ServiceManager::status(const std::string& text) const {
  sd_notify(0, ("STATUS=" + text).c_str());
}

void ServiceManager::stopping() const { sd_notify(0, "STOPPING=1"); }

void ServiceManager::alive() {
  const auto now = std::chrono::steady_clock::now();
  if (!every_ || now - last_ < *every_) return;
  last_ = now;
  sd_notify(0, "WATCHDOG=1");
}

}  // namespace imunoise::app
