#include "core/support/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <atomic>

namespace imunoise {

void for_each_index(std::size_t count, const std::function<void(std::size_t)>& work) {
  if (count == 1) {
    work(0);
    return;
  }
  // What the caller wrote is seen by the items, and what they wrote by the caller. oneTBB sees to
  // that too, inside a library that ThreadSanitizer cannot look into; this says it where it can.
  std::atomic<std::size_t> done = 0;
  std::atomic<bool> begun = false;
  begun.store(true, std::memory_order_release);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    (void)begun.load(std::memory_order_acquire);
    work(i);
    done.fetch_add(1, std::memory_order_release);
  });
  (void)done.load(std::memory_order_acquire);
}

ThreadLimit::ThreadLimit(std::size_t threads)
    : control_(new tbb::global_control(tbb::global_control::max_allowed_parallelism, threads)) {}

ThreadLimit::~ThreadLimit() { delete static_cast<tbb::global_control*>(control_); }

}  // namespace imunoise
