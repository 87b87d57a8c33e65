// What a child of `fork` may do with the library of its parent.
#include <gtest/gtest.h>

#include <optional>

#include "tests/runtime/forked.hpp"
#include "wale/library.hpp"

namespace wale::library_forking_test {
namespace {

TEST(LibraryForking, TheChildHasAWorkerOfItsOwnAndDoesNotWaitForTheParents) {
  std::optional<Library> library(std::in_place);
  ASSERT_TRUE(library->find_later("oil").get());
  auto under_way = library->find_later("corduroy");
  EXPECT_EQ(in_a_child([&] {
              if (!library->find("oil")) return 1;
              if (!library->find_later("oil").get()) return 2;
              library.reset();
              return 0;
            }),
            0);
  EXPECT_EQ(in_a_child([&] {
              library.reset();
              return 0;
            }),
            0);
  EXPECT_TRUE(under_way.get()) << "the parent's work goes on";
}

}  // namespace
}  // namespace wale::library_forking_test
