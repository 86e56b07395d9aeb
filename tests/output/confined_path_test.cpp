// Outputs below their folder: links, foreign names, things that are no files.
#include "core/error.h"
#include "output/output_path.h"

#include "support/folder.h"

#include <gtest/gtest.h>

#include <sys/stat.h>

#include <filesystem>
#include <string>

namespace tumble::confined_path_test {
namespace {

namespace fs = std::filesystem;

class ConfinedPath : public ::testing::Test {
protected:
    void SetUp() override {
        fs::create_directories(folder_ / "root/in");
        fs::create_directories(folder_ / "out");
        write_text(folder_ / "out/secret", "secret");
        write_text(folder_ / "root/file", "file");
    }
    void link(const std::string& to, const std::string& name) { fs::create_symlink(to, folder_ / ("root/" + name)); }
    bool refused(const std::string& name, InnerLinks links = InnerLinks::followed) {
        try {
            EXPECT_EQ(confined_path(folder_ / "root", name, links), folder_ / "root" / name);
            return false;
        } catch (const InputError&) {
            return true;
        }
    }
    TestFolder folder_;
};

TEST_F(ConfinedPath, FilesAndNewFolders) {
    EXPECT_FALSE(refused("file"));
    EXPECT_FALSE(refused("new"));
    EXPECT_FALSE(refused("in/new"));
    EXPECT_FALSE(refused("a/b/new"));
    EXPECT_NO_THROW(confined_path(folder_ / "none", "new"));
}

TEST_F(ConfinedPath, NamesThatLeadOut) {
    for (const char* name : {"../x", "in/../../x", "..", "/tmp/x", ""}) EXPECT_TRUE(refused(name)) << name;
}

TEST_F(ConfinedPath, LinksThatLeadOut) {
    link("../out/secret", "relative");
    link((folder_ / "out/secret").string(), "absolute");
    link("../out/none", "dangling");
    link("../nowhere/none", "lost");
    link("/dev/null", "device");
    link("../out", "parent");
    link("../nowhere", "lost_parent");
    link("relative", "twice");
    link("..", "up");
    for (const char* name : {"relative", "absolute", "dangling", "lost", "device", "parent/new", "parent/secret",
                             "lost_parent/new", "twice", "up/out/secret", "up/new"})
        EXPECT_TRUE(refused(name)) << name;
}

TEST_F(ConfinedPath, LinksThatStayInside) {
    link("file", "inside");
    link("in", "parent");
    link("in/none", "dangling");
    for (const char* name : {"inside", "parent/new", "dangling"}) {
        EXPECT_FALSE(refused(name)) << name;
        EXPECT_TRUE(refused(name, InnerLinks::refused)) << name;
    }
    EXPECT_FALSE(refused("in/new", InnerLinks::refused));
}

TEST_F(ConfinedPath, ARootThatIsALink) {
    fs::create_symlink("root", folder_ / "link");
    EXPECT_NO_THROW(confined_path(folder_ / "link", "file"));
    link("../out/secret", "escape");
    EXPECT_THROW(confined_path(folder_ / "link", "escape"), InputError);
}

TEST_F(ConfinedPath, ThingsThatAreNoFiles) {
    ASSERT_EQ(mkfifo((folder_ / "root/pipe").c_str(), 0600), 0);
    EXPECT_TRUE(refused("pipe"));
    EXPECT_TRUE(refused("in"));
}

}  // namespace
}  // namespace tumble::confined_path_test
