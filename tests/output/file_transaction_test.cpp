// Several files get their names together: all or none, after a process that is killed at any rename.
#include "output/file_transaction.h"
#include "core/error.h"

#include "killed_rename.h"
#include "support/folder.h"

#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

namespace tumble::file_transaction_test {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> names{"a.png", "in/b.png", "c.png", "new/d.png"};

class Transactions : public ::testing::Test {
protected:
    void SetUp() override {
        fs::create_directories(folder_ / "in");
        for (const char* name : {"a.png", "in/b.png", "c.png"}) write_text(folder_ / name, "old");
    }

    void commit() {
        FileTransaction files(folder_.path());
        for (const std::string& name : names) files.add(name, "new");
        files.commit();
    }

    /// Contents of the four files: "oldoldold", "newnewnewnew", or a mixture.
    std::string contents() {
        std::string all;
        for (const std::string& name : names) all += read_text(folder_ / name);
        return all;
    }

    TestFolder folder_;
};

TEST_F(Transactions, AllFilesGetTheirNames) {
    commit();
    EXPECT_EQ(contents(), "newnewnewnew");
    EXPECT_EQ(folder_.files(), 4u);  // nothing hidden stays
}

TEST_F(Transactions, WithoutCommitNothingChanges) {
    {
        FileTransaction files(folder_.path());
        files.add("a.png", "new");
        EXPECT_EQ(read_text(folder_ / "a.png"), "old");
    }
    EXPECT_EQ(contents(), "oldoldold");
    EXPECT_EQ(folder_.files(), 3u);
}

TEST_F(Transactions, AfterARenameThatFailsTheNextRunGoesOn) {
    FileTransaction* files = new FileTransaction(folder_.path());
    for (const std::string& name : names) files->add(name, "new");
    fs::remove(folder_ / "c.png");
    fs::create_directories(folder_ / "c.png/full");
    EXPECT_THROW(files->commit(), std::exception);
    delete files;
    EXPECT_EQ(read_text(folder_ / "a.png"), "new");
    fs::remove_all(folder_ / "c.png");
    finish_left_transactions(folder_.path());
    EXPECT_EQ(contents(), "newnewnewnew");
    EXPECT_EQ(folder_.files(), 4u);
}

TEST_F(Transactions, AJournalFromElsewhereStaysBelowItsFolder) {
    const TestFolder outside;
    write_text(outside / "file", "mine");
    fs::create_symlink(outside.path(), folder_ / "out");
    fs::create_directories(folder_ / ".tumble.new-abcdef");
    write_text(folder_ / ".tumble.new-abcdef/.tumble.temporary", "");
    write_text(folder_ / ".tumble.new-abcdef/0", "hostile");
    for (const std::string& name : {std::string("out/file"), std::string("../file"), (outside / "file").string()}) {
        write_text(folder_ / ".tumble.new-abcdef/journal",
                   std::string("tumble-journal 1\n") + name + std::string(2, '\0'));
        EXPECT_THROW(finish_left_transactions(folder_.path()), InputError) << name;
        EXPECT_EQ(read_text(outside / "file"), "mine");
    }
}

TEST_F(Transactions, AJournalThatIsCutRenamesNothing) {
    fs::create_directories(folder_ / ".tumble.new-abcdef");
    write_text(folder_ / ".tumble.new-abcdef/.tumble.temporary", "");
    write_text(folder_ / ".tumble.new-abcdef/0", "new");
    write_text(folder_ / ".tumble.new-abcdef/journal", std::string("tumble-journal 1\na.png") + '\0');
    finish_left_transactions(folder_.path());
    EXPECT_EQ(contents(), "oldoldold");
    EXPECT_FALSE(fs::exists(folder_ / ".tumble.new-abcdef"));
}

TEST_F(Transactions, KilledAtAnyRenameItIsAllOrNone) {
    std::string last;
    for (int at = 0;; ++at) {
        for (const std::string& name : names) fs::remove(folder_ / name);
        for (const char* name : {"a.png", "in/b.png", "c.png"}) write_text(folder_ / name, "old");
        const pid_t id = fork();
        if (id == 0) {
            renames_until_kill = at;
            commit();
            _exit(0);
        }
        int status = 0;
        waitpid(id, &status, 0);
        finish_left_transactions(folder_.path());
        const std::string found = contents();
        EXPECT_TRUE(found == "oldoldold" || found == "newnewnewnew") << at << ": " << found;
        EXPECT_TRUE(at == 0 || last != "newnewnewnew" || found == "newnewnewnew") << at;
        last = found;
        if (WIFEXITED(status)) break;
        ASSERT_LT(at, 100);
    }
    EXPECT_EQ(last, "newnewnewnew");
    for (const auto& entry : fs::directory_iterator(folder_.path()))
        EXPECT_NE(entry.path().filename().string().front(), '.') << entry.path();
}

}  // namespace
}  // namespace tumble::file_transaction_test
