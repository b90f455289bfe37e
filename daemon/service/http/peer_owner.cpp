#include "daemon/service/http/peer_owner.h"

#include <arpa/inet.h>
#include <linux/inet_diag.h>
#include <linux/netlink.h>
#include <linux/sock_diag.h>
#include <netinet/in.h>

#include <array>
#include <cstring>

#include "core/support/descriptor.h"

namespace imunoise::service {
namespace {

struct Query {
  nlmsghdr head{};
  inet_diag_req_v2 body{};
};

// As the kernel numbers the other end: its own address and port come first.
bool fill_ends(int socket, inet_diag_req_v2& out) {
  sockaddr_storage ours{};
  sockaddr_storage theirs{};
  socklen_t our_size = sizeof ours;
  socklen_t their_size = sizeof theirs;
  const auto generic = [](sockaddr_storage& of) {
    return static_cast<sockaddr*>(static_cast<void*>(&of));
  };
  if (::getsockname(socket, generic(ours), &our_size) != 0 ||
      ::getpeername(socket, generic(theirs), &their_size) != 0 ||
      ours.ss_family != theirs.ss_family) {
    return false;
  }
  out.sdiag_family = static_cast<__u8>(ours.ss_family);
  const auto fill = [&](const sockaddr_storage& from, __be32* address, __be16& port) {
    if (from.ss_family == AF_INET6) {
      sockaddr_in6 six{};
      std::memcpy(&six, &from, sizeof six);
      std::memcpy(address, &six.sin6_addr, sizeof six.sin6_addr);
      port = six.sin6_port;
    } else {
      sockaddr_in four{};
      std::memcpy(&four, &from, sizeof four);
      std::memcpy(address, &four.sin_addr, sizeof four.sin_addr);
      port = four.sin_port;
    }
  };
  fill(theirs, out.id.idiag_src, out.id.idiag_sport);
  fill(ours, out.id.idiag_dst, out.id.idiag_dport);
  return ours.ss_family == AF_INET || ours.ss_family == AF_INET6;
}

}  // namespace

std::optional<uid_t> owner_of_peer(int socket) {
  Query query;
  query.head.nlmsg_len = sizeof query;
  query.head.nlmsg_type = SOCK_DIAG_BY_FAMILY;
  query.head.nlmsg_flags = NLM_F_REQUEST;
  query.body.sdiag_protocol = IPPROTO_TCP;
  query.body.idiag_states = ~0U;
  query.body.id.idiag_cookie[0] = query.body.id.idiag_cookie[1] = INET_DIAG_NOCOOKIE;
  if (!fill_ends(socket, query.body)) return std::nullopt;
  const Descriptor kernel(
      ::socket(AF_NETLINK, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, NETLINK_SOCK_DIAG));
  if (kernel.get() < 0 || ::send(kernel.get(), &query, sizeof query, 0) != sizeof query)
    return std::nullopt;
  alignas(nlmsghdr) std::array<char, 1024> answer{};
  const ssize_t size = ::recv(kernel.get(), answer.data(), answer.size(), 0);
  nlmsghdr head{};
  inet_diag_msg body{};
  if (size < static_cast<ssize_t>(NLMSG_HDRLEN + sizeof body)) return std::nullopt;
  std::memcpy(&head, answer.data(), sizeof head);
  if (head.nlmsg_type != SOCK_DIAG_BY_FAMILY) return std::nullopt;
  std::memcpy(&body, answer.data() + NLMSG_HDRLEN, sizeof body);
  return body.idiag_uid;
}

}  // namespace imunoise::service
