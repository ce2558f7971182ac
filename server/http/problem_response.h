#pragma once
// Errors as RFC 9457 problem documents.

#include "engine/scene/problem.h"
#include "server/http/message.h"

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace toile {

/// What a handler throws to answer with a problem. `code` is a stable word for programs, `detail` a sentence for
/// people, `errors` the places in the document that was sent.
struct HttpProblem : std::runtime_error {
  HttpProblem(int problem_status, std::string problem_code, const std::string& detail)
      : std::runtime_error(detail), status(problem_status), code(std::move(problem_code)) {}
  HttpProblem& with_header(std::string name, std::string value) {
    headers.emplace_back(std::move(name), std::move(value));
    return *this;
  }
  int status;
  std::string code;
  std::vector<std::pair<std::string, std::string>> headers;
};

/// application/problem+json as problem.schema.json has it; the code stands in its one entry of `errors`.
HttpResponse problem_response(const HttpProblem& problem);
/// The answer to input that the readers refused: 400 for what is no JSON, 413 for what is too large, else 422.
HttpResponse problem_response(const InputError& error);

}  // namespace toile
