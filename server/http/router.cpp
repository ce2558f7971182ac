#include "server/http/router.h"

#include "server/http/problem_response.h"

#include <optional>
#include <set>

namespace toile {
namespace {

/// Takes the text up to the next slash off the front.
std::string_view take_segment(std::string_view& path) {
  const std::size_t end = std::min(path.find('/'), path.size());
  const std::string_view segment = path.substr(0, end);
  path.remove_prefix(std::min(end + 1, path.size()));
  return segment;
}

std::optional<std::vector<std::string>> captures_of(std::string_view pattern, std::string_view path) {
  if (pattern.empty() || path.empty() || path.front() != '/') return std::nullopt;
  if ((path.back() == '/') != (pattern.back() == '/')) return std::nullopt;
  pattern.remove_prefix(1);
  path.remove_prefix(1);
  std::vector<std::string> captures;
  while (!pattern.empty() && !path.empty()) {
    const std::string_view wanted = take_segment(pattern), given = take_segment(path);
    if (wanted == "{}" && !given.empty()) {
      captures.emplace_back(given);
    } else if (wanted != given) {
      return std::nullopt;
    }
  }
  if (!pattern.empty() || !path.empty()) return std::nullopt;
  return captures;
}

}  // namespace

RouteMatch Router::match(std::string_view method, std::string_view path) const {
  const std::string_view wanted = method == "HEAD" ? "GET" : method;
  std::set<std::string> allowed;
  for (const Route& route : routes_) {
    if (auto captures = captures_of(route.path, path)) {
      if (route.method == wanted) return {&route, std::move(*captures)};
      allowed.insert(route.method);
      if (route.method == "GET") allowed.insert("HEAD");
    }
  }
  if (allowed.empty()) throw HttpProblem(404, "no_such_resource", "There is nothing at this path.");
  std::string list;
  for (const std::string& name : allowed) list += (list.empty() ? "" : ", ") + name;
  throw HttpProblem(405, "method_not_allowed", "This path takes " + list + ".").with_header("Allow", list);
}

}  // namespace toile
