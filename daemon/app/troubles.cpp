#include "daemon/app/troubles.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace imunoise::app {
namespace {

// By their names alone: a disk that hangs cannot be asked.
std::filesystem::path plain(const std::string& path) {
  std::error_code unknown;
  return std::filesystem::absolute(path, unknown).lexically_normal();
}

bool lies_in(const std::filesystem::path& path, const std::filesystem::path& folder) {
  const auto whole = (folder / ".").lexically_normal().parent_path();
  return std::mismatch(whole.begin(), whole.end(), path.begin(), path.end()).first == whole.end();
}

}  // namespace

Troubles find_troubles(const std::vector<v1::Campaign>& campaigns,
                       const std::vector<recording::DiskCall>& calls, const live::LiveBoard& board,
                       live::Steady::time_point now) {
  Troubles out;
  for (const recording::DiskCall& call : calls) {
    const auto trouble = live::trouble_of(call, now);
    if (!trouble) continue;
    const auto path = plain(call.path.string());
    const auto of = std::find_if(campaigns.begin(), campaigns.end(), [&](const auto& one) {
      return lies_in(path, plain(one.folder()));
    });
    out.emplace(of == campaigns.end() ? kNoCampaign : of->name(), *trouble);
  }
  for (const v1::Campaign& one : campaigns) {
    if (auto trouble = board.trouble(one.name(), now)) out.emplace(one.name(), *trouble);
  }
  return out;
}

std::string hanging_since(const Troubles& troubles, live::Steady::time_point before) {
  for (const auto& [name, trouble] : troubles) {
    if (trouble.hangs && trouble.since <= before) return name + ": " + live::sentence(trouble);
  }
  return "";
}

}  // namespace imunoise::app
