#include "server/http/problem_response.h"

#include <nlohmann/json.hpp>

namespace toile {

// clang-format off
std::string_view title_of(int status) {
  switch (status) {
    case 400: return "Bad Request";
    case 404: return "Not Found";
    case 405: return "Method Not Allowed";
    case 409: return "Conflict";
    case 411: return "Length Required";
    case 413: return "Content Too Large";
    case 414: return "URI Too Long";
    case 415: return "Unsupported Media Type";
    case 422: return "Unprocessable Content";
    case 431: return "Request Header Fields Too Large";
    case 503: return "Service Unavailable";
    case 507: return "Insufficient Storage";
    default: return status < 500 ? "Bad Request" : "Internal Server Error";
  }
}
// clang-format on

HttpResponse problem_response(const HttpProblem& problem) {
  nlohmann::json document{{"type", "about:blank"},
                          {"title", title_of(problem.status)},
                          {"status", problem.status},
                          {"code", problem.code},
                          {"detail", problem.what()}};
  for (const Problem& place : problem.errors) {
    document["errors"].push_back({{"pointer", place.pointer}, {"code", place.code}, {"detail", place.detail}});
  }
  HttpResponse response;
  response.status = problem.status;
  response.content_type = "application/problem+json";
  response.body = document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  response.headers = problem.headers;
  return response;
}

HttpProblem problem_of(const InputError& error) {
  const Problem& first = error.problems().front();
  int status = 422;
  if (first.code == "json_too_large") status = 413;
  if (first.code == "json_syntax") status = 400;
  return {status, first.code, first.detail, error.problems()};
}

}  // namespace toile
