#include "core/support/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

namespace imunoise {

void for_each_index(std::size_t count, const std::function<void(std::size_t)>& work) {
  if (count == 1) {
    work(0);
    return;
  }
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) { work(i); });
}

ThreadLimit::ThreadLimit(std::size_t threads)
    : control_(new tbb::global_control(tbb::global_control::max_allowed_parallelism, threads)) {}

ThreadLimit::~ThreadLimit() { delete static_cast<tbb::global_control*>(control_); }

}  // namespace imunoise
