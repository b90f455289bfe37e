#include "daemon/service/api/routes.h"

#include <google/protobuf/descriptor.h>

#include <initializer_list>
#include <optional>

namespace imunoise::service {
namespace {

constexpr std::string_view kRest = "=**";

PathPart part_of(std::string text) {
  if (text.front() != '{') return {std::move(text)};
  std::string name = text.substr(1, text.size() - 2);
  const bool rest = name.ends_with(kRest);
  if (rest) name.resize(name.size() - kRest.size());
  return {std::move(name), true, rest};
}

std::vector<PathPart> parts_of(const std::string& path) {
  std::vector<PathPart> out;
  for (std::size_t begin = 1; begin < path.size();) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    out.push_back(part_of(path.substr(begin, end - begin)));
    begin = end + 1;
  }
  return out;
}

Route route_of(const google::protobuf::MethodDescriptor& method) {
  Route out;
  out.method = &method;
  out.http = method.options().GetExtension(v1::http);
  const std::initializer_list<std::pair<const char*, const std::string&>> ways = {
      {"GET", out.http.get()}, {"POST", out.http.post()}, {"DELETE", out.http.delete_()}};
  for (const auto& [verb, path] : ways) {
    if (path.empty()) continue;
    out.verb = verb;
    out.path = path;
  }
  out.parts = parts_of(out.path);
  return out;
}

std::string joined(const std::vector<std::string>& segments, std::size_t from) {
  std::string out = segments[from];
  for (std::size_t i = from + 1; i < segments.size(); ++i) out += "/" + segments[i];
  return out;
}

// The fields of the path, where it fits the route.
std::optional<TextFields> match(const Route& route, const std::vector<std::string>& segments) {
  TextFields out;
  for (std::size_t i = 0; i < route.parts.size(); ++i) {
    const PathPart& part = route.parts[i];
    if (i >= segments.size() || (!part.field && part.name != segments[i])) return std::nullopt;
    if (part.rest) {
      out.emplace_back(part.name, joined(segments, i));
      return out;
    }
    if (part.field) out.emplace_back(part.name, segments[i]);
  }
  return route.parts.size() == segments.size() ? std::optional(std::move(out)) : std::nullopt;
}

}  // namespace

Routes::Routes(const google::protobuf::FileDescriptor& file) {
  for (int i = 0; i < file.service_count(); ++i) {
    for (int j = 0; j < file.service(i)->method_count(); ++j) {
      routes_.push_back(route_of(*file.service(i)->method(j)));
    }
  }
}

Found Routes::find(const std::string& verb, const Target& target) const {
  Found out;
  for (const Route& route : routes_) {
    auto fields = match(route, target.segments);
    if (!fields) continue;
    out.allowed += (out.allowed.empty() ? "" : ", ") + route.verb;
    if (route.verb != verb) continue;
    out.route = &route;
    out.fields = std::move(*fields);
    return out;
  }
  return out;
}

}  // namespace imunoise::service
