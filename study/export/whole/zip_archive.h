#pragma once

#include <string>
#include <vector>

namespace imunoise::study {

struct ArchiveMember {
  std::string name;
  std::string bytes;
};

/// A ZIP archive with its members stored as they are (APPNOTE 6.3.10), dated 1980-01-01 so that the
/// same members give the same bytes. At most 65,535 members, 4 GiB in all.
std::string zip_archive(const std::vector<ArchiveMember>& members);

}  // namespace imunoise::study
