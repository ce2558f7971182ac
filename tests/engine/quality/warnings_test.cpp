#include "engine/quality/warnings.h"

#include "tests/engine/solve/sheets.h"

#include <gmock/gmock.h>

namespace toile {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> warnings(const Report& report, double contact_distance = 2e-3) {
  const Cloth sheet = equilateral_sheet(5, 5, 0.01, suiting());
  Report said = report;
  add_warnings(sheet, std::vector<double>(sheet.x.size(), contact_distance), said);
  return said.warnings;
}

TEST(AddWarnings, OfClothSqueezedBeyondItsModel) {
  Report report;
  report.compressed_share = 0.0005;
  EXPECT_THAT(warnings(report), IsEmpty());
  report.compressed_share = 0.03;
  EXPECT_THAT(warnings(report), ElementsAre(HasSubstr("compressed beyond the model: 3.0 %")));
}

TEST(AddWarnings, OfThinLayersWhereClothTouchesCloth) {
  Report report;
  EXPECT_THAT(warnings(report, 0.5e-3), IsEmpty()) << "no layers";
  report.contacts.cloth = 3;
  EXPECT_THAT(warnings(report, 2e-3), IsEmpty());
  EXPECT_THAT(warnings(report, 0.5e-3), ElementsAre(testing::AllOf(HasSubstr("thin layers"), HasSubstr("0.05"))));
}

TEST(AddWarnings, OfForcesThatDoNotBalance) {
  Report report;
  report.residual_rms = 0.3;
  EXPECT_THAT(warnings(report), ElementsAre(HasSubstr("not at rest")));
}

}  // namespace
}  // namespace toile
