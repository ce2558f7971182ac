#include "schemas/problem.h"

#include <nlohmann/json.hpp>

namespace toile {

namespace {

using nlohmann::json;

int status_of(const std::vector<Problem>& problems) {
  const std::string& code = problems.front().code;
  if (code == "json_too_large") return 413;
  return code.rfind("json_", 0) == 0 && problems.front().pointer.rfind("/garments/", 0) != 0 ? 400 : 422;
}

const char* phrase(int status) {
  switch (status) {
    case 400:
      return "Bad Request";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 406:
      return "Not Acceptable";
    case 409:
      return "Conflict";
    case 410:
      return "Gone";
    case 411:
      return "Length Required";
    case 413:
      return "Content Too Large";
    case 414:
      return "URI Too Long";
    case 415:
      return "Unsupported Media Type";
    case 416:
      return "Range Not Satisfiable";
    case 422:
      return "Unprocessable Content";
    case 429:
      return "Too Many Requests";
    case 500:
      return "Internal Server Error";
    case 503:
      return "Service Unavailable";
    case 507:
      return "Insufficient Storage";
    default:
      return status < 500 ? "Client Error" : "Server Error";
  }
}

}  // namespace

std::string utf8(const std::string& text) {
  return json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::replace)).get<std::string>();
}

json problem_document(const InputError& error) {
  json errors = json::array();
  for (const Problem& problem : error.problems()) {
    errors.push_back({{"pointer", utf8(problem.pointer)}, {"code", problem.code}, {"detail", utf8(problem.detail)}});
  }
  return {{"type", "urn:toile:problem:input"},
          {"title", "The input can't be simulated"},
          {"status", status_of(error.problems())},
          {"detail", errors[0]["detail"]},
          {"errors", errors}};
}

json problem_document(int status, const std::string& detail) {
  return {{"type", "about:blank"}, {"title", phrase(status)}, {"status", status}, {"detail", utf8(detail)}};
}

}  // namespace toile
