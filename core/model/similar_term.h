#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "core/model/model.h"

namespace imunoise {

/// Number of the term that a process most likely became in a fit: of those of its kind that
/// `allowed` names, the one whose spectrum is most like its own in shape. Terms of a kind change
/// their order from fit to fit, see sorted().
std::optional<std::size_t> similar_term(
    const Model& model, const Process& process,
    const std::function<bool(std::size_t)>& allowed = [](std::size_t) { return true; });

}  // namespace imunoise
