#pragma once

// Another program, run beside us at the lowest priority.

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/progress.h"
#include "core/support/result.h"

namespace imunoise::process {

/// What a program is told, and who listens to it.
struct Talk {
  std::string input = {};  ///< All that it reads on standard input.
  /// Takes each line of its standard output, on the caller's thread; empty: that is part of what it
  /// said, as standard errors are.
  std::function<void(std::string_view line)> hear = {};
  /// Called on the caller's thread while the program works: each time it has used the processor for
  /// another 20 ms, or said something, but not more often than ten times a second. A program that
  /// waits for a disk does neither.
  std::function<void()> works = {};
};

/// Runs a program to its end: `command` is its path and its arguments. It yields the processor and,
/// where memory is short, its life to everybody else. The caller's wish to stop ends it with
/// SIGTERM, after three seconds with SIGKILL. Error: it cannot be run, was ended by a signal, or
/// its exit status was not 0: then with the last of what it said.
Result<void> run_program(const std::vector<std::string>& command, const Progress& progress,
                         const Talk& talk = {});

}  // namespace imunoise::process
