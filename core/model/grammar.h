#pragma once

// What the terms of a model mean.

#include <string>
#include <string_view>
#include <vector>

#include "core/model/model.h"
#include "core/model/syntax.h"

namespace imunoise {

/// What a reader of models can use beside the noise of one sensor. What it cannot use is refused
/// where it stands.
struct Grammar {
  bool sharing = false;  ///< how sensors share a process: RW[all]
  bool trends = false;   ///< which parameters follow a covariate: WN(sigma2~exp)
  /// Why there can be no effects, a clause for people; empty: they are taken.
  std::string no_effects{};
  /// Why no effect may change the noise itself; empty: it may.
  std::string one_noise{};
};

/// For models whose sampling rate is not known yet: what can be read at this rate is well written.
inline constexpr Hertz kAnyRate{1e6};

/// Adds `count` times the process that a term of `text` says. Error: model_error() at what is
/// wrong.
Result<void> add_process(const WrittenTerm& written, std::string_view text, Hertz rate,
                         const Grammar& grammar, Model& to);

/// True where a name is that of a process; case does not matter.
bool is_process(std::string_view name);
/// WN, QN, RW, ...
std::vector<std::string> known_process_names();
/// "unknown process or effect 'ARW'; did you mean WN (angle random walk)?", or the names that there
/// are.
std::string unknown_term(std::string_view name, const std::vector<std::string>& effects);

}  // namespace imunoise
