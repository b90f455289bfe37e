#pragma once

#include <cstddef>
#include <functional>

namespace imunoise {

/// Calls work(i) for i = 0 .. count-1, on several threads. The items are the fixed blocks of a
/// computation: the caller stores each item's result under its index and combines them in order,
/// so that the answer does not depend on the number of threads. `work` must be thread-safe.
void for_each_index(std::size_t count, const std::function<void(std::size_t)>& work);

/// Limits the number of threads that for_each_index uses while it lives (for tests and --threads).
class ThreadLimit {
 public:
  explicit ThreadLimit(std::size_t threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  void* control_;
};

}  // namespace imunoise
