#include "core/error.h"
#include "core/check.h"

#include <gtest/gtest.h>

namespace tumble::error_test {
namespace {

TEST(Errors, NameThePlaceAsFarAsItIsKnown) {
    EXPECT_STREQ(InputError("no scene").what(), "error: no scene");
    EXPECT_STREQ(InputError({"a.toml", 3, 7}, "bad").what(), "a.toml:3:7: error: bad");
    EXPECT_STREQ(InputError({"a.toml", 0, 0}, "cannot be read").what(), "a.toml: error: cannot be read");
    EXPECT_STREQ(RunError("disk full").what(), "error: disk full");
}

TEST(ChecksDeathTest, ShowBothValues) {
    TUMBLE_CHECK_EQ(2 + 2, 4);
    EXPECT_DEATH(TUMBLE_CHECK_LT(7, 3), "error_test.cpp:[0-9]+: broken contract: 7 < 3 .with 7 and 3.");
}

}  // namespace
}  // namespace tumble::error_test
