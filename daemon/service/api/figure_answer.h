#pragma once

// Figures as responses.

#include "daemon/service/api/answer.h"
#include "imunoise/v1/service.pb.h"
#include "study/figure/figure.h"
#include "study/figure/svg.h"

namespace imunoise::service {

/// Error: 400 for a size that no figure has (px; 0: the figure's own).
Answer<void> check_figure_size(std::uint32_t width, std::uint32_t height);

/// The figure as SVG, as `request` asks: its fields width, height and standalone. Error: that of
/// check_figure_size.
template <class Request>
Answer<v1::Text> figure_answer(const figure::Figure& figure, const Request& request) {
  if (auto good = check_figure_size(request.width(), request.height()); !good)
    return tl::unexpected(good.error());
  figure::SvgOptions how;
  how.variant =
      request.standalone() ? figure::SvgVariant::kStandalone : figure::SvgVariant::kInline;
  if (request.width() != 0) how.width = request.width();
  how.height = request.height();
  v1::Text out;
  out.set_text(figure::svg(figure, how));
  return out;
}

}  // namespace imunoise::service
