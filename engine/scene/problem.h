#pragma once
// What is wrong with an input, said so that the person who sent it can find the place.

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace toile {

/// One finding. `pointer` is an RFC 6901 JSON pointer into the scene document (for a pattern inline in it, or into the
/// pattern's own document, prefixed with the pointer of the pattern in the scene); `code` is a stable snake_case word
/// for programs (`open_panel_loop`, `edge_stitched_twice`, …); `detail` is a sentence for people.
struct Problem {
  std::string pointer;
  std::string code;
  std::string detail;
};

/// Input that can't be simulated. Thrown by readers, by meshing and by the scene check; becomes an RFC 9457 problem at
/// the edge. Holds at least one problem.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Problem> problems)
      : std::runtime_error(problems.front().detail), problems_(std::move(problems)) {}
  InputError(std::string pointer, std::string code, std::string detail)
      : InputError(std::vector<Problem>{{std::move(pointer), std::move(code), std::move(detail)}}) {}
  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

}  // namespace toile
