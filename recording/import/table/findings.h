#pragma once

// What the preflight recognised in a file, and what it found wrong with it.

#include <cstddef>
#include <string>
#include <vector>

namespace imunoise::recording {

enum class Severity {
  kDoubt,    ///< The numbers may mislead; they are used all the same.
  kLeftOut,  ///< Samples are left out, or the recording is cut.
};

/// One finding: a sentence, with the time, the row and what to do.
struct Finding {
  Severity severity = Severity::kDoubt;
  std::string text;
};

/// A stream of a sensor that was left out because its rate is another; by itself it can be read.
struct OtherStream {
  std::string name;       ///< a topic, or names of channels separated by commas
  bool is_topic = false;  ///< what the name is: for options.topic, else for options.channels
};

/// The preflight of one file.
struct Preflight {
  std::string file;
  std::vector<std::string> recognised;  ///< "time: column t, ms; 100 Hz"
  std::vector<Finding> findings;
  std::size_t samples = 0;  ///< rows of the file
  std::size_t used = 0;     ///< rows of all stretches
  std::size_t stretches = 0;
  std::vector<OtherStream> others;  ///< that hold angular rates or accelerations
};

}  // namespace imunoise::recording
