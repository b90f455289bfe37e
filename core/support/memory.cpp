#include "core/support/memory.h"

#include <malloc.h>

namespace imunoise {

void keep_freed_memory() {
  constexpr int kLongestKept = 16 << 20;  // bytes at once
  constexpr int kKept = 1 << 30;
  mallopt(M_MMAP_THRESHOLD, kLongestKept);
  mallopt(M_TRIM_THRESHOLD, kKept);
}

}  // namespace imunoise
