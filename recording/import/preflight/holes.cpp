#include "recording/import/preflight/holes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/support/counted.h"

namespace imunoise::recording {

bool missing(const Column& column, std::size_t row) {
  const auto* const numbers = std::get_if<std::vector<double>>(&column.samples);
  return numbers != nullptr && !std::isfinite((*numbers)[row]);
}

bool repeats(const Column& column, std::size_t row) {
  return std::visit([&](const auto& values) { return values[row] == values[row - 1]; },
                    column.samples);
}

std::string Hole::said() const {
  const bool several = names.size() > 1;
  return fmt::format("{} {} {} {}{}", plural(names.size(), "channel"), fmt::join(names, ", "),
                     several ? "miss" : "misses", counted(count, "value"), several ? " each" : "");
}

std::vector<Hole> holes_in(std::span<const Column> columns) {
  std::vector<Hole> out;
  for (const Column& column : columns) {
    Hole hole{{column.name}};
    for (std::size_t i = 0; i < size(column.samples); ++i) {
      if (missing(column, i) && hole.count++ == 0) hole.first = i;
    }
    if (hole.count == 0) continue;
    const auto alike = std::find_if(out.begin(), out.end(), [&](const Hole& one) {
      return one.count == hole.count && one.first == hole.first;
    });
    if (alike == out.end()) {
      out.push_back(std::move(hole));
    } else {
      alike->names.push_back(column.name);
    }
  }
  return out;
}

}  // namespace imunoise::recording
