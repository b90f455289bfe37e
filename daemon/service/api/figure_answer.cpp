#include "daemon/service/api/figure_answer.h"

#include <fmt/format.h>

namespace imunoise::service {
namespace {

constexpr std::uint32_t kLeastWidth = 200;  // px
constexpr std::uint32_t kMostPixels = 4000;

}  // namespace

Answer<void> check_figure_size(std::uint32_t width, std::uint32_t height) {
  if ((width != 0 && width < kLeastWidth) || width > kMostPixels || height > kMostPixels)
    return refuse(400, fmt::format("width: {} to {} px; height: at most {} px", kLeastWidth,
                                   kMostPixels, kMostPixels));
  return {};
}

}  // namespace imunoise::service
