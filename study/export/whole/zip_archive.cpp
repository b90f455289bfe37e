#include "study/export/whole/zip_archive.h"

#include <boost/crc.hpp>
#include <cassert>
#include <cstdint>
#include <limits>

namespace imunoise::study {
namespace {

void put(std::string& to, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) to += static_cast<char>(value >> (8 * i) & 0xffU);
}

std::uint32_t crc_of(const std::string& bytes) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

// What a member's own header and the directory both say of it.
std::string description(const ArchiveMember& member) {
  constexpr std::uint64_t kFirstDay = 1U << 5U | 1U;  // of 1980, in the format of MS-DOS
  std::string out;
  put(out, 20, 2);         // version needed: 2.0
  put(out, 1U << 11U, 2);  // names are UTF-8
  put(out, 0, 2);          // stored
  put(out, 0, 2);          // midnight
  put(out, kFirstDay, 2);
  put(out, crc_of(member.bytes), 4);
  put(out, member.bytes.size(), 4);
  put(out, member.bytes.size(), 4);
  put(out, member.name.size(), 2);
  put(out, 0, 2);  // extra fields
  return out;
}

}  // namespace

std::string zip_archive(const std::vector<ArchiveMember>& members) {
  std::string out;
  std::string directory;
  for (const ArchiveMember& one : members) {
    const std::string described = description(one);
    directory += "PK\x01\x02";
    put(directory, 20, 2);  // version that made it
    directory += described;
    put(directory, 0, 2);  // comment
    put(directory, 0, 2);  // disk
    put(directory, 0, 2);  // internal attributes
    put(directory, 0, 4);  // external attributes
    put(directory, out.size(), 4);
    directory += one.name;
    out += "PK\x03\x04" + described + one.name + one.bytes;
  }
  assert(out.size() < std::numeric_limits<std::uint32_t>::max());
  const std::size_t start = out.size();
  out += directory + "PK\x05\x06";
  put(out, 0, 4);  // disks
  put(out, members.size(), 2);
  put(out, members.size(), 2);
  put(out, directory.size(), 4);
  put(out, start, 4);
  put(out, 0, 2);  // comment
  return out;
}

}  // namespace imunoise::study
