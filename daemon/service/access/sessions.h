#pragma once

// Who came with a token before and now shows a cookie.

#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "imunoise/v1/http.pb.h"

namespace imunoise::service {

/// Thread-safe. Sessions end with the program; beyond 256 the oldest ends.
class Sessions {
 public:
  /// A token that opens one session of this role, once.
  std::string invite(v1::Role role);
  /// The role of an invitation, which is used up; nothing where there is none.
  std::optional<v1::Role> redeem(std::string_view token);
  /// A new session: what its cookie holds.
  std::string open(v1::Role role);
  std::optional<v1::Role> role_of(std::string_view session) const;

 private:
  struct Pass {
    std::string text;
    v1::Role role;
  };
  mutable std::mutex mutex_;
  std::deque<Pass> invitations_;
  std::deque<Pass> sessions_;
};

/// The name of the cookie of a service that is asked by this Host: services on several ports of one
/// machine share cookies.
std::string cookie_name(std::string_view host);

/// The value of a cookie in the header Cookie; empty where it is absent.
std::string_view cookie_value(std::string_view header, std::string_view name);

}  // namespace imunoise::service
