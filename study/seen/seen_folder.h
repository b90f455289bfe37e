#pragma once

// A cache of results from recordings, so that they are computed once. All of it may
// be deleted at any time.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "imunoise/v1/study.pb.h"
#include "study/analysis/seen_channel.h"

namespace imunoise::study {

struct SeenPlaces {
  /// In the folder `.imunoise` beside the first file (in a recording's folder, inside it).
  bool beside = true;
  /// Where that cannot be written, or was not wanted; empty: nowhere.
  std::filesystem::path other{};
  /// That a folder holds, of all recordings: those longest unused are deleted first. A study gets a
  /// quarter.
  std::uintmax_t most_bytes = std::uintmax_t{4} << 30U;
};

/// Of the recordings of one study. What was kept is found again as long as no file of them was
/// written to, moved or put in another's place. Nothing here fails: what cannot be kept is worked
/// out again.
class SeenFolder {
 public:
  /// Looks at the files' stamps now: make it before they are read. Folders of other users, and
  /// links, are left alone.
  SeenFolder(const v1::StudyInput& input, const SeenPlaces& places);

  /// A channel without its witnesses.
  std::optional<SeenChannel> find(const std::string& channel) const;
  /// A witness of that channel.
  std::optional<Witness> find_witness(const std::string& channel, const std::string& witness) const;
  /// The channel, and the witnesses of its subject unless they are too many.
  void keep(const SeenChannel& seen) const;

 private:
  std::string name_of(const std::string& channel, const std::string& witness) const;

  std::string input_;   // which files, and how they are read
  std::string stamps_;  // of the files now
  std::vector<std::filesystem::path> folders_;
  std::uintmax_t most_bytes_;
};

}  // namespace imunoise::study
