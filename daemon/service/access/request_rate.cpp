#include "daemon/service/access/request_rate.h"

#include <algorithm>

namespace imunoise::service {

bool RequestRate::pass(const std::string& peer, Time now) {
  const std::lock_guard lock(mutex_);
  Bucket& bucket = buckets_.try_emplace(peer, Bucket{burst_, now}).first->second;
  const double passed = std::chrono::duration<double>(now - bucket.filled).count();
  bucket.left = std::min(burst_, bucket.left + per_second_ * passed);
  bucket.filled = now;
  if (bucket.left < 1.0) return false;
  bucket.left -= 1.0;
  return true;
}

}  // namespace imunoise::service
