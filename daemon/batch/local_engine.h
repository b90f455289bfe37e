#pragma once

#include "daemon/batch/engine.h"

namespace imunoise::batch {

/// Workers are child processes on this machine, so many at once, which share its processors.
class LocalEngine final : public Engine {
 public:
  LocalEngine(Worker worker, std::size_t workers) : worker_(std::move(worker)), workers_(workers) {}
  Result<void> run(const std::vector<std::uint32_t>& shards,
                   const std::function<bool()>& go_on) override;

 private:
  Worker worker_;
  std::size_t workers_;
};

}  // namespace imunoise::batch
