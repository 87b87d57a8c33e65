// The interface for programs that ask for materials and levels by name.

#include <gtest/gtest.h>

#include "wale/library.hpp"

namespace wale::by_name_test {
namespace {

TEST(ByName, AMaterialIsThatOfItsFile) {
  const Library library;
  const auto named = library.material("denim"),
             from_file = library.material(std::string(WALE_SOURCE_DIR) + "/library/fabric/denim.wale");
  ASSERT_TRUE(named) << in_words(named.error());
  ASSERT_TRUE(from_file) << in_words(from_file.error());
  EXPECT_EQ(write_patch_program(named->description()), write_patch_program(from_file->description()));
}

TEST(ByName, ErrorsAreAboutTheArgument) {
  const Library library;
  const auto percept = library.level("rougness", "coarse"), level = library.level("roughness", "coarze"),
             text = library.level("roughness", "0.5 } }"), high = library.level("roughness", "1.5"),
             device = library.level("roughness", "coarse", "falcom");
  const struct {
    const Result<Program>& result;
    Code code;
    const char *place, *mend;
  } cases[] = {{percept, Code::unknown_name, "percept", "`roughness`"},
               {level, Code::unknown_name, "level", "`coarse`"},
               {text, Code::malformed_value, "level", "\"0.6\""},
               {high, Code::level_out_of_range, "level", ""},
               {device, Code::unknown_device, "device", "`falcon`"}};
  for (const auto& each : cases) {
    ASSERT_FALSE(each.result);
    const Error& error = each.result.error();
    EXPECT_EQ(error.code, each.code) << error.sentence;
    EXPECT_EQ(error.place.name, each.place) << error.sentence;
    EXPECT_NE(error.mend.find(each.mend), std::string::npos) << error.mend;
  }
  const auto material = library.material("corderoy");
  ASSERT_FALSE(material);
  EXPECT_EQ(material.error().code, Code::unknown_name);
  EXPECT_NE(material.error().mend.find("`corduroy`"), std::string::npos) << material.error().mend;
}

TEST(ByName, AnErrorInAFileHasItsLine) {
  const auto wrong = Library().material(std::string(WALE_SOURCE_DIR) + "/library/fabric/denim.wale", "velvet");
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().code, Code::unknown_material);
  EXPECT_TRUE(wrong.error().place.name.ends_with("library/fabric/denim.wale"));
  EXPECT_TRUE(wrong.error().place.number.has_value());
}

}  // namespace
}  // namespace wale::by_name_test
