#include "schemas/parse_json.h"

#include "tests/schemas/files.h"

#include <gmock/gmock.h>
#include <chrono>
#include <nlohmann/json.hpp>

namespace toile {
namespace {

using testing::problems_of;

struct Nasty {
  const char* name;
  std::string bytes;
  const char* code;
  const char* pointer;
};

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int k = 0; k < times; ++k) all += text;
  return all;
}

class NastyJson : public ::testing::TestWithParam<Nasty> {};

TEST_P(NastyJson, IsRefusedWithItsPlace) {
  const auto problems = problems_of([&] { parse_json(GetParam().bytes); });
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].code, GetParam().code);
  EXPECT_EQ(problems[0].pointer, GetParam().pointer);
}

INSTANTIATE_TEST_SUITE_P(
    All, NastyJson,
    ::testing::Values(Nasty{"Nothing", "", "json_syntax", ""}, Nasty{"Cut", R"({"a": [1, 2)", "json_syntax", ""},
                      Nasty{"TwoDocuments", "{} {}", "json_syntax", ""}, Nasty{"NaN", "[NaN]", "json_syntax", ""},
                      Nasty{"Infinity", "[-Infinity]", "json_syntax", ""},
                      Nasty{"Comment", "[1] // one", "json_syntax", ""},
                      Nasty{"TrailingComma", "[1,]", "json_syntax", ""},
                      Nasty{"LoneContinuationByte", "[\"\x80\"]", "json_syntax", ""},
                      Nasty{"OverlongSlash", "[\"\xc0\xaf\"]", "json_syntax", ""},
                      Nasty{"LoneSurrogate", R"(["\ud800"])", "json_syntax", ""},
                      Nasty{"RawControlCharacter", std::string("[\"a\0b\"]", 7), "json_syntax", ""},
                      Nasty{"RawNulAtTheEnd", std::string("{}\0 {}", 6), "json_syntax", ""},
                      Nasty{"TooLarge", R"({"a": [0, 1e400]})", "json_number_out_of_range", "/a/1"},
                      Nasty{"TooLargeInAnObject", R"([{}, {"b/c": -1e999}])", "json_number_out_of_range", "/1/b~1c"},
                      Nasty{"HundredThousandArrays", repeated("[", 100000) + repeated("]", 100000), "json_too_deep",
                            "/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0"},
                      Nasty{"HundredThousandObjects", repeated("{\"a\":", 100000), "json_too_deep",
                            "/a/a/a/a/a/a/a/a/a/a/a/a/a/a/a/a/a/a/a/a/a/a/a/a/a/a/a/a/a/a/a/a"},
                      Nasty{"SameKeyTwice", R"({"a": 1, "b": {"c": 2, "c": 3}})", "json_duplicate_key", "/b/c"},
                      Nasty{"SameKeyTwiceEscaped", R"([[], {"a": 1, "\u0061": 3}])", "json_duplicate_key", "/1/a"}),
    [](const auto& nasty) { return std::string(nasty.param.name); });

TEST(ParseJson, TakesThirtyTwoLevelsAndNotOneMore) {
  EXPECT_NO_THROW(parse_json(repeated("[", 32) + repeated("]", 32)));
  EXPECT_EQ(problems_of([] { parse_json(repeated("[", 33) + repeated("]", 33)); }).size(), 1u);
}

TEST(ParseJson, LimitsTheSize) {
  EXPECT_NO_THROW(parse_json("[1, 2]", {.bytes = 6}));
  EXPECT_EQ(problems_of([] { parse_json("[1, 2]", {.bytes = 5}); })[0].code, "json_too_large");
}

TEST(ParseJson, LimitsTheNumberOfValues) {
  EXPECT_NO_THROW(parse_json("[1, {\"a\": 2}]", {.values = 4}));
  EXPECT_EQ(problems_of([] { parse_json("[1, {\"a\": 2}]", {.values = 3}); })[0].code, "json_too_large");
}

/// A parser's callback looks at all siblings after each object: 100 s for these.
TEST(ParseJson, ManySiblingsTakeAsLongAsTheirBytes) {
  const auto start = std::chrono::steady_clock::now();
  parse_json("[" + repeated("{\"a\": 1},", 450000) + "{}]");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

TEST(ParseJson, TheSameKeyMayStandInTwoObjects) { EXPECT_EQ(parse_json(R"([{"a": 1}, {"a": 2}])")[1]["a"], 2); }

TEST(ParseJson, LargeIntegersBecomeDoubles) {
  EXPECT_DOUBLE_EQ(parse_json("[123456789012345678901234567890]")[0].get<double>(), 123456789012345678901234567890.0);
}

}  // namespace
}  // namespace toile
