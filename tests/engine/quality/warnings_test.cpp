#include "engine/quality/warnings.h"

#include "tests/engine/solve/sheets.h"

#include <gmock/gmock.h>

namespace toile {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> warnings_of(const Cloth& sheet, const Report& report, double contact_distance = 2e-3,
                                     double asked = 0) {
  SolverOptions options;
  options.contact_distance = asked;
  Report said = report;
  add_warnings(sheet, std::vector<double>(sheet.x.size(), contact_distance), options, said);
  return said.warnings;
}

std::vector<std::string> warnings(const Report& report, double contact_distance = 2e-3, double asked = 0) {
  return warnings_of(equilateral_sheet(5, 5, 0.01, suiting()), report, contact_distance, asked);
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

TEST(AddWarnings, OfLayersNearerThanTheyShouldBe) {
  Report report;
  EXPECT_THAT(warnings(report, 1.3e-3, 3e-3), IsEmpty()) << "no layers";
  report.contacts.cloth = 3;
  EXPECT_THAT(warnings(report, 3e-3, 3e-3), IsEmpty());
  EXPECT_THAT(warnings(report, 1.3e-3, 3e-3), ElementsAre(testing::AllOf(HasSubstr("near layers: on 100 %"),
                                                                         HasSubstr("3.0 mm"), HasSubstr("1.3 mm"))));
  Cloth fleece = equilateral_sheet(5, 5, 0.01, suiting());
  fleece.fabrics[0].thickness = 2.2e-3;
  EXPECT_THAT(warnings_of(fleece, report, 1.3e-3), ElementsAre(HasSubstr("2.2 mm")));
}

TEST(AddWarnings, OfEdgesTooLongForTheFabricsFolds) {
  Cloth sheet = equilateral_sheet(5, 5, 0.01, suiting());
  Fabric& fabric = sheet.fabrics[0];
  const auto with_bending_length = [&](double length) {
    const double d = fabric.area_density * kGravity * length * length * length;
    fabric.bending_stiffness = {d, d, d};
    return warnings_of(sheet, {});
  };
  EXPECT_THAT(with_bending_length(6.8e-3), IsEmpty());
  EXPECT_THAT(with_bending_length(6.5e-3),
              ElementsAre(testing::AllOf(HasSubstr("coarse mesh"), HasSubstr("10.0 mm"), HasSubstr("6.5 mm"))));
}

TEST(AddWarnings, OfOverstretchedWovenClothWhateverKnitsAreBesideIt) {
  Cloth sheet = equilateral_sheet(6, 6, 0.01, suiting());
  sheet.fabrics[0].woven = true;
  for (Vec3& x : sheet.x) x *= 1.08;
  EXPECT_THAT(warnings_of(sheet, {}), ElementsAre(HasSubstr("more than 8.0 %")));
  Fabric knit = sheet.fabrics[0];
  knit.woven = false;
  sheet.fabrics.push_back(knit);
  sheet.panels.push_back(sheet.panels[0]);
  sheet.panels[1].fabric = 1;
  for (std::size_t t = 0; t < sheet.triangles.size(); t += 2) sheet.triangle_panel[t] = 1;
  EXPECT_THAT(warnings_of(sheet, {}), ElementsAre(HasSubstr("more than 8.0 %")));
  sheet.fabrics[0].woven = false;
  EXPECT_THAT(warnings_of(sheet, {}), IsEmpty());
}

TEST(AddWarnings, OfAllThatAReaderShouldNotOverlookBesideWhatWasSaidBefore) {
  Report report;
  report.penetration_max = 1e-3;
  report.residual_rms = 0.01;
  EXPECT_THAT(warnings(report), IsEmpty());
  report.warnings = {"said before"};
  report.penetration_max = 3.4e-3;
  report.self_intersections = 17;
  report.residual_rms = 0.5;
  EXPECT_THAT(warnings(report), testing::UnorderedElementsAre("said before", HasSubstr("3.4 mm"), HasSubstr("17 pairs"),
                                                              HasSubstr("0.50")));
}

TEST(WarnOfFarGarments, WhereNothingOfOneIsNearAndWhereItIsHeldInTheAir) {
  const BodyField ball = make_body_field({SphereBody{Vec3::Zero(), 0.1}, 0.3}, 0.01);
  Cloth sheet = equilateral_sheet(4, 4, 0.01, suiting());
  const auto said = [&](double height, const std::vector<int>& attached, char on_body = 1) {
    Positions kept = sheet.x;
    for (Vec3& x : sheet.x) x = Vec3(x.x(), height, x.y());
    Report report;
    warn_of_far_garments(sheet, ball, attached, {{on_body}, 1e-3}, report);
    sheet.x = kept;
    return report.warnings;
  };
  EXPECT_THAT(said(0.105, {}), IsEmpty());
  EXPECT_THAT(said(0.105, {0, 1}), IsEmpty());
  EXPECT_THAT(said(0.1515, {}, 0), IsEmpty()) << "hangs by pins of its own";
  EXPECT_THAT(said(0.1515, {}), ElementsAre(HasSubstr("nowhere nearer to it than 50 mm")));
  EXPECT_THAT(said(0.1515, {0}), ElementsAre(HasSubstr("attached of garment 0 is held over 50 mm")));
}

TEST(AddWarnings, OfForcesThatDoNotBalance) {
  Report report;
  report.residual_rms = 0.3;
  EXPECT_THAT(warnings(report), ElementsAre(HasSubstr("not at rest")));
  report.residual_rms = 0.07;
  EXPECT_THAT(warnings(report), ElementsAre(HasSubstr("not at rest")));
  report.status = "converged";  // a step after the last look at forces may leave a little more than was asked
  EXPECT_THAT(warnings(report), IsEmpty());
}

}  // namespace
}  // namespace toile
