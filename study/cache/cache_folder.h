#pragma once

// A cache of results from recordings, so that they are computed once. All of it may
// be deleted at any time.

#include <filesystem>
#include <optional>
#include <string>

#include "imunoise/v1/study.pb.h"
#include "study/analysis/prepared_channel.h"

namespace imunoise::study {

/// Where results are kept, and how much.
struct CachePlace {
  std::filesystem::path folder;  ///< Empty: nothing is kept.
  /// Of all recordings together; imunoise deletes those longest unused first. A study gets half.
  std::uintmax_t most_bytes = std::uintmax_t{2} << 30U;
};

/// The user's cache folder, as the XDG base directory specification has it; empty if there is none.
std::filesystem::path user_cache_folder();

/// Of the recordings of one study. What was kept is found again as long as no file of them was
/// written to, moved or put in another's place. Nothing here fails: what cannot be kept is worked
/// out again.
class CacheFolder {
 public:
  /// Looks at the files' stamps now: make it before they are read. A folder of another user, or a
  /// link, is left alone.
  CacheFolder(const v1::StudyInput& input, CachePlace place);

  /// A channel without its witnesses.
  std::optional<PreparedChannel> find(const std::string& channel) const;
  /// A witness of that channel.
  std::optional<Witness> find_witness(const std::string& channel, const std::string& witness) const;
  /// The channel, and the witnesses of its subject unless they are too many.
  void keep(const PreparedChannel& prepared) const;

 private:
  std::string name_of(const std::string& channel, const std::string& witness) const;

  std::string input_;   // which files, and how they are read
  std::string stamps_;  // of the files now
  CachePlace place_;
};

}  // namespace imunoise::study
