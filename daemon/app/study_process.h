#pragma once

// Studies are computed in processes of their own: whatever a recording does to a computation, or a
// computation to the memory, recording goes on.

#include <iosfwd>
#include <string>
#include <vector>

#include "daemon/service/studies/study_computation.h"
#include "recording/store/disk/disk_calls.h"

namespace imunoise::app {

/// The one argument of imunoised that makes it such a process.
inline constexpr const char* kComputeWord = "--compute";

/// Runs a command for every order, which does as compute_for_parent(): as it stands, the program
/// that runs already, whatever has been installed since. A process that crashes is an error like
/// others.
/// `calls` outlive it: a child that hangs is among them.
service::ComputeStudy compute_in_child(recording::DiskCalls& calls,
                                       std::vector<std::string> command = {"/proc/self/exe",
                                                                           kComputeWord});

/// The child's side: reads a JobOrder, writes JobReports, a line each. Returns the exit status.
int compute_for_parent(std::istream& in, std::ostream& out);

}  // namespace imunoise::app
