#pragma once
// What every store has to do, as one parameterised suite. A store joins by
//   INSTANTIATE_TEST_SUITE_P(Name, StoreContract, testing::Values(StoreMaker{…}));

#include "server/store/store.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>

namespace toile {

/// Opens the store of a folder; opening the same folder again, after the first store is gone, finds the same contents.
using StoreMaker = std::function<std::unique_ptr<Store>(const std::string& folder)>;

class StoreContract : public testing::TestWithParam<StoreMaker> {
 protected:
  void SetUp() override;
  void reopen();
  /// Submits a job at `now` under a name that ends in `last`.
  JobRecord submit(int number, TimeMs now = 1000);

  const TemporaryFolder folder_;
  std::unique_ptr<Store> store_;
};

}  // namespace toile
