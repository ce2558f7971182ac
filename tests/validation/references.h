#pragma once
// Values that this project's code did not compute (shared/validation/references.json).

#include <gtest/gtest.h>

#include <string>

namespace toile::test {

/// Whether the references are there; tests that need them skip where they are not.
bool have_references();

/// The number at a JSON pointer, such as "/cantilever/8/drop". Throws where there is none.
double reference(const std::string& pointer);

/// Index of the row of a list whose `key` has the value. Throws where there is none.
int reference_row(const std::string& list_pointer, const std::string& key, double value);

}  // namespace toile::test

#define SKIP_WITHOUT_REFERENCES() \
  if (!toile::test::have_references()) GTEST_SKIP() << "no ../shared/validation/references.json"
