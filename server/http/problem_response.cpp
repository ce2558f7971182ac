#include "server/http/problem_response.h"

#include "schemas/problem.h"

#include <nlohmann/json.hpp>

namespace toile {
namespace {

HttpResponse problem_response(const nlohmann::json& document) {
  HttpResponse response;
  response.status = document["status"].get<int>();
  response.content_type = "application/problem+json";
  response.body = document.dump() + "\n";
  return response;
}

}  // namespace

HttpResponse problem_response(const HttpProblem& problem) {
  nlohmann::json document = problem_document(problem.status, problem.what());
  document["errors"] =
      nlohmann::json::array({{{"pointer", ""}, {"code", problem.code}, {"detail", document["detail"]}}});
  HttpResponse response = problem_response(document);
  response.headers = problem.headers;
  return response;
}

HttpResponse problem_response(const InputError& error) { return problem_response(problem_document(error)); }

}  // namespace toile
