#pragma once

// Computations on studies, one after the other, beside recording and never in its way.

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "core/support/progress.h"
#include "core/support/result.h"
#include "daemon/service/api/answer.h"
#include "imunoise/v1/service.pb.h"

namespace imunoise::service {

/// Thread-safe.
class Jobs {
 public:
  using Work = std::function<Result<v1::Study>(const Progress& progress)>;
  /// From any thread; without the result. Must not call this object.
  using Changed = std::function<void(const v1::Job& job)>;

  /// At most so many wait.
  Jobs(std::size_t waiting, Changed changed);
  /// Cancels all, and waits for the one that works.
  ~Jobs();
  Jobs(const Jobs&) = delete;
  Jobs& operator=(const Jobs&) = delete;

  /// Error: 503, too many wait.
  Answer<v1::Job> add(const std::string& operation, const std::string& study, Work work);
  /// Error: 404.
  Answer<v1::Job> get(const std::string& job) const;
  /// The same once it is over, or so much later.
  Answer<v1::Job> wait(const std::string& job, std::chrono::duration<double> patience) const;
  /// Asks it to end. Error: 404.
  Answer<v1::Job> cancel(const std::string& job);
  /// Oldest first, without results. Of those that are over, the latest are kept.
  std::vector<v1::Job> list() const;

 private:
  using Clock = std::chrono::steady_clock;
  struct Entry {
    v1::Job job;
    Work work;
    std::stop_source stop;
    Clock::time_point began;
    Clock::time_point told;  // of its progress
  };

  void run(const std::stop_token& stop);
  void work_on(const std::shared_ptr<Entry>& entry);
  void progress(Entry& entry, double fraction);
  std::shared_ptr<Entry> find(const std::string& job) const;  // with the mutex held
  void forget_old();                                          // likewise
  void tell(const v1::Job& job) const;

  const std::size_t waiting_;
  const Changed changed_;
  mutable std::mutex mutex_;
  mutable std::condition_variable_any news_;
  std::deque<std::shared_ptr<Entry>> entries_;
  std::uint64_t count_ = 0;
  std::jthread thread_;  // last: it uses all of the above
};

/// True once the job will not change any more.
bool over(const v1::Job& job);

}  // namespace imunoise::service
