// Temporary folders: those of killed processes are removed by the next, and no others.
#include "output/temporary_folder.h"

#include "support/folder.h"

#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace tumble::temporary_folder_test {
namespace {

namespace fs = std::filesystem;

/// A process that holds a temporary folder until it is killed.
class Holder {
public:
    explicit Holder(const std::string& purpose) {
        int ends[2];
        EXPECT_EQ(pipe(ends), 0);
        id_ = fork();
        if (id_ == 0) {
            const TemporaryFolder folder(purpose);
            write_text(folder.path() / "file", "content");
            fs::create_directory(folder.path() / "inner");
            const std::string path = folder.path().string() + "\n";
            if (write(ends[1], path.data(), path.size()) < 0) _exit(1);
            pause();
        }
        close(ends[1]);
        for (char c; read(ends[0], &c, 1) == 1 && c != '\n';) path_ += c;
        close(ends[0]);
    }
    ~Holder() { end(); }

    const std::string& path() const { return path_; }
    void end() {
        if (id_ <= 0) return;
        kill(id_, SIGKILL);
        waitpid(id_, nullptr, 0);
        id_ = -1;
    }

private:
    pid_t id_;
    std::string path_;
};

class TemporaryFolders : public ::testing::Test {
protected:
    void SetUp() override { setenv("TMPDIR", folder_.path().c_str(), 1); }
    void TearDown() override { unsetenv("TMPDIR"); }
    TestFolder folder_;
};

TEST_F(TemporaryFolders, ThatOfAKilledProcessIsRemovedByTheNextForAnyPurpose) {
    Holder living("page"), killed("accept");
    killed.end();
    EXPECT_TRUE(fs::exists(killed.path()));
    {
        const TemporaryFolder next("compare");
        EXPECT_FALSE(fs::exists(killed.path()));
        EXPECT_TRUE(fs::exists(living.path() + "/file"));
        EXPECT_TRUE(fs::exists(next.path()));
    }
    living.end();
    { const TemporaryFolder next("golden"); }
    EXPECT_EQ(folder_.files(), 0u);
}

TEST_F(TemporaryFolders, FoldersThatMerelyHaveSuchANameStay) {
    fs::create_directories(folder_ / "tumble-accept-backup");
    write_text(folder_ / "tumble-accept-backup/frame", "mine");
    write_text(folder_ / "tumble-accept-backup/.tumble.lock", "");
    fs::create_directories(folder_ / "tumble-page-abc123");
    fs::create_directories(folder_ / "tumble-page-abc124/.tumble.temporary");
    fs::create_directories(folder_ / "elsewhere");
    write_text(folder_ / "elsewhere/.tumble.temporary", "");
    fs::create_directory_symlink("elsewhere", folder_ / "tumble-page-abc125");
    fs::create_directories(folder_ / "tumble-page-abc126");
    fs::create_symlink("../elsewhere/.tumble.temporary", folder_ / "tumble-page-abc126/.tumble.temporary");
    write_text(folder_ / "tumble-page-abc127", "a file");
    { const TemporaryFolder next("page"); }
    EXPECT_EQ(folder_.files(), 7u);
    EXPECT_EQ(read_text(folder_ / "tumble-accept-backup/frame"), "mine");
}

TEST_F(TemporaryFolders, OneOfThisProcessStays) {
    const TemporaryFolder first("page"), second("page");
    EXPECT_TRUE(fs::exists(first.path()));
}

}  // namespace
}  // namespace tumble::temporary_folder_test
