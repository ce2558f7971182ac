#pragma once
// A request and a response as the handlers see them: plain values, no socket, no library.

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace toile {

struct HttpRequest {
  std::string method;
  std::string path;                            ///< percent-decoded, without the query
  std::vector<std::string> captures;           ///< what stood for the {} of the route
  std::map<std::string, std::string> query;    ///< percent-decoded; the first of each name
  std::map<std::string, std::string> headers;  ///< names in lower case; the first of each name
  std::string body;

  std::optional<std::string> header(const std::string& lower_case_name) const {
    const auto found = headers.find(lower_case_name);
    return found == headers.end() ? std::nullopt : std::optional(found->second);
  }
};

struct HttpResponse {
  int status = 200;
  std::string content_type = "application/json";
  std::string body;
  std::vector<std::pair<std::string, std::string>> headers;
};

}  // namespace toile
