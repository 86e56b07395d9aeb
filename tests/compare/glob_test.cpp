// Patterns of file names: each wildcard, folders, mistakes, and work that stays bounded.
#include "compare/glob.h"

#include <gtest/gtest.h>

namespace tumble::glob_test {
namespace {

TEST(Glob, WildcardsStayWithinAName) {
    EXPECT_TRUE(glob_matches("a/*.png", "a/b.png"));
    EXPECT_FALSE(glob_matches("a/*.png", "a/b/c.png"));
    EXPECT_TRUE(glob_matches("a/b?.png", "a/b1.png"));
    EXPECT_FALSE(glob_matches("a?b.png", "a/b.png"));
    EXPECT_TRUE(glob_matches("a/*", "a/"));
}

TEST(Glob, APatternWithoutFolderStandsForNamesInAnyFolder) {
    EXPECT_TRUE(glob_matches("*.png", "a/b/c.png"));
    EXPECT_TRUE(glob_matches("c.png", "a/b/c.png"));
    EXPECT_FALSE(glob_matches("b", "a/b/c.png"));
}

TEST(Glob, TwoStarsStandForFolders) {
    EXPECT_TRUE(glob_matches("a/**/c.png", "a/c.png"));
    EXPECT_TRUE(glob_matches("a/**/c.png", "a/x/y/c.png"));
    EXPECT_FALSE(glob_matches("a/**/c.png", "a/xc.png"));
    EXPECT_TRUE(glob_matches("**/c.png", "c.png"));
    EXPECT_TRUE(glob_matches("a/**", "a/x/y/c.png"));
    EXPECT_FALSE(glob_matches("a/**", "b/a/c.png"));
}

TEST(Glob, Sets) {
    EXPECT_TRUE(glob_matches("frame_[0-4]?.png", "frame_37.png"));
    EXPECT_FALSE(glob_matches("frame_[0-4]?.png", "frame_57.png"));
    EXPECT_TRUE(glob_matches("[!ab].png", "c.png"));
    EXPECT_FALSE(glob_matches("[!ab].png", "a.png"));
    EXPECT_TRUE(glob_matches("[]x].png", "].png"));
    EXPECT_TRUE(glob_matches("[a-]b", "-b"));
    EXPECT_FALSE(glob_matches("a[!x]b/c", "a/b/c"));  // no set stands for '/'
    EXPECT_TRUE(glob_matches("\\*.png", "*.png"));
    EXPECT_FALSE(glob_matches("\\*.png", "a.png"));
}

TEST(Glob, Mistakes) {
    for (const char* pattern : {"", "/a.png", "a[b.png", "a\\"}) EXPECT_TRUE(glob_mistake(pattern)) << pattern;
    for (const char* pattern : {"*", "a[b].png", "\\[a.png", "[]].png"}) EXPECT_FALSE(glob_mistake(pattern)) << pattern;
}

TEST(Glob, ManyStarsTakeNoTime) {
    std::string pattern;
    for (int i = 0; i < 200; ++i) pattern += "*a";
    EXPECT_FALSE(glob_matches(pattern, std::string(2000, 'a') + "b"));
}

}  // namespace
}  // namespace tumble::glob_test
