#include "core/process/averaging_filters.h"

namespace imunoise {

std::vector<double> boxcar_taps(int n) {
  return std::vector<double>(static_cast<std::size_t>(n), 1.0 / n);
}

std::vector<double> bartlett_taps(int n) {
  std::vector<double> out;
  for (int i = 1 - n; i < n; ++i) {
    out.push_back(static_cast<double>(n - (i < 0 ? -i : i)) / (static_cast<double>(n) * n));
  }
  return out;
}

}  // namespace imunoise
