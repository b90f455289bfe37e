#pragma once

// Another program, run beside us at the lowest priority.

#include <stop_token>
#include <string>
#include <vector>

#include "core/support/progress.h"
#include "core/support/result.h"

namespace imunoise::process {

/// Runs a program to its end: `command` is its path and its arguments. It yields the processor and,
/// where memory is short, its life to everybody else. The caller's wish to stop ends it with
/// SIGTERM, after three seconds with SIGKILL. Error: it cannot be run, was ended by a signal, or
/// its exit status was not 0: then with the last of what it said.
Result<void> run_program(const std::vector<std::string>& command, const Progress& progress);

}  // namespace imunoise::process
