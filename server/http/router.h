#pragma once
// From method and path to a handler: path parameters, 404, and 405 with Allow, which the HTTP library does not do.

#include "server/http/message.h"

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace toile {

using HttpHandler = std::function<HttpResponse(const HttpRequest&)>;

/// What bodies a route takes.
struct BodyRule {
  std::size_t limit = 0;  ///< bytes; 0: no body
  bool json_only = false;
};

struct Route {
  std::string method;  ///< GET (which serves HEAD too), POST, DELETE
  std::string path;    ///< "/v1/jobs/{}/report": {} stands for one segment that is not empty
  HttpHandler handle;
  BodyRule body;
};

struct RouteMatch {
  const Route* route = nullptr;
  std::vector<std::string> captures;
};

class Router {
 public:
  void add(Route route) { routes_.push_back(std::move(route)); }
  /// Throws HttpProblem 404 or 405.
  RouteMatch match(std::string_view method, std::string_view path) const;
  const std::vector<Route>& routes() const { return routes_; }

 private:
  std::vector<Route> routes_;
};

}  // namespace toile
