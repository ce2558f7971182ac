#pragma once
// Errors as RFC 9457 problem documents.

#include "engine/scene/problem.h"
#include "server/http/message.h"

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace toile {

/// What a handler throws to answer with a problem. `code` is a stable word for programs, `detail` a sentence for
/// people, `errors` the places in the document that was sent.
struct HttpProblem : std::runtime_error {
  HttpProblem(int problem_status, std::string problem_code, const std::string& detail, std::vector<Problem> places = {})
      : std::runtime_error(detail), status(problem_status), code(std::move(problem_code)), errors(std::move(places)) {}
  HttpProblem& with_header(std::string name, std::string value) {
    headers.emplace_back(std::move(name), std::move(value));
    return *this;
  }
  int status;
  std::string code;
  std::vector<Problem> errors;
  std::vector<std::pair<std::string, std::string>> headers;
};

/// application/problem+json with type, title, status, code, detail and errors [{pointer, code, detail}].
HttpResponse problem_response(const HttpProblem& problem);

/// The answer to input that the readers refused: 400 for what is no JSON, 413 for what is too large, else 422.
HttpProblem problem_of(const InputError& error);

/// The reason phrase of a status ("Not Found").
std::string_view title_of(int status);

}  // namespace toile
