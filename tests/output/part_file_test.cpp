// Part files: those of a killed process are removed, those of a living one stay, and a final name appears only when the
// bytes are on the disk. fsync() and rename() are replaced below.
#include "output/part_file.h"
#include "core/error.h"
#include "output/temporary_file.h"

#include "killed_rename.h"
#include "support/folder.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <limits.h>
#include <sys/file.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <string>
#include <vector>

namespace {

std::vector<std::string> calls;  // in order, with the last part of the path
int sync_error = 0;              // error of the next fsync()

std::string last_part(const std::string& path) { return path.substr(path.rfind('/') + 1); }

}  // namespace

extern "C" int fsync(int file) {
    char path[PATH_MAX + 1] = {};
    if (readlink(("/proc/self/fd/" + std::to_string(file)).c_str(), path, PATH_MAX) < 0) return -1;
    calls.push_back("sync " + last_part(path));
    if (sync_error != 0) {
        errno = sync_error;
        return -1;
    }
    return int(syscall(SYS_fsync, file));
}

int tumble::renames_until_kill = -1;

extern "C" int rename(const char* from, const char* to) noexcept {
    if (tumble::renames_until_kill == 0) raise(SIGKILL);
    if (tumble::renames_until_kill > 0) --tumble::renames_until_kill;
    calls.push_back("rename " + last_part(from));
    return int(syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}

namespace tumble::part_file_test {
namespace {

namespace fs = std::filesystem;

/// The file that a process leaves if it is killed while it writes.
fs::path part_of_a_killed_process(const fs::path& final_path) {
    int ends[2];
    EXPECT_EQ(pipe(ends), 0);
    const pid_t id = fork();
    if (id == 0) {
        TemporaryFile file(final_path);
        file.write("half");
        const std::string name = file.path().string();
        if (write(ends[1], name.data(), name.size()) > 0) raise(SIGKILL);
        _exit(1);
    }
    close(ends[1]);
    char name[PATH_MAX] = {};
    EXPECT_GT(read(ends[0], name, sizeof name - 1), 0);
    close(ends[0]);
    int status = 0;
    waitpid(id, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status));
    EXPECT_TRUE(fs::exists(name));
    return name;
}

TEST(PartFile, TheBytesAreOnTheDiskBeforeTheName) {
    const TestFolder folder;
    TemporaryFile file(folder / "a.txt");
    file.write("new");
    const std::string part = file.path().filename().string();
    calls.clear();
    file.commit();
    EXPECT_EQ(calls, (std::vector<std::string>{"sync " + part, "rename " + part,
                                               "sync " + folder.path().filename().string()}));
}

TEST(PartFile, AFileThatCannotBeSyncedGetsNoName) {
    const TestFolder folder;
    write_text(folder / "a.txt", "old");
    {
        TemporaryFile file(folder / "a.txt");
        file.write("new");
        sync_error = EIO;
        EXPECT_THROW(file.commit(), RunError);
        sync_error = 0;
    }
    EXPECT_EQ(read_text(folder / "a.txt"), "old");
    EXPECT_EQ(folder.files(), 1u);
    TemporaryFile file(folder / "a.txt");
    file.write("new");
    sync_error = EINVAL;  // a file system without sync
    file.commit();
    sync_error = 0;
    EXPECT_EQ(read_text(folder / "a.txt"), "new");
}

TEST(PartFile, PartsOfAKilledProcessAreRemoved) {
    const TestFolder folder;
    const fs::path left = part_of_a_killed_process(folder / "a.txt");
    const fs::path other = part_of_a_killed_process(folder / "b.txt");
    TemporaryFile file(folder / "a.txt");
    EXPECT_FALSE(fs::exists(left));
    EXPECT_TRUE(fs::exists(other)) << "the part of another name";
}

TEST(PartFile, PartsOfALivingProcessStay) {
    const TestFolder folder;
    TemporaryFile living(folder / "a.txt");
    living.write("first");
    {
        TemporaryFile second(folder / "a.txt");
        EXPECT_TRUE(fs::exists(living.path()));
        second.write("second");
        second.commit();
    }
    EXPECT_EQ(read_text(folder / "a.txt"), "second");
    living.commit();
    EXPECT_EQ(read_text(folder / "a.txt"), "first");
}

TEST(PartFile, OnlyNamesOfPartsAreRemoved) {
    const TestFolder folder;
    const std::vector<std::string> others = {".a.txt.part-0123abcd",          "a.txt.tumble.part-0123abcd",
                                             ".a.txt.tumble.part-0123abc",    ".a.txt.tumble.part-0123ABCD",
                                             ".a.txt.tumble.part-0123abcde",  ".a.txt.tumble.part-0123abcd.txt",
                                             ".x.a.txt.tumble.part-0123abcd", ".tumble.part-0123abcd"};
    for (const std::string& name : others) write_text(folder / name, "kept");
    fs::create_directory(folder / ".a.txt.tumble.part-00000000");
    fs::create_symlink(others[0], folder / ".a.txt.tumble.part-00000001");
    write_text(folder / ".a.txt.tumble.part-00000002", "half");
    remove_left_parts(folder / "a.txt");
    EXPECT_EQ(folder.files(), others.size() + 2);
    EXPECT_FALSE(fs::exists(folder / ".a.txt.tumble.part-00000002"));
}

TEST(PartFile, NamesAsLongAsThereAreAny) {
    const TestFolder folder;
    for (const std::size_t length : {230u, 231u, 254u, 255u}) {
        const std::string name = std::string(length - 4, 'n') + ".txt";
        const fs::path left = part_of_a_killed_process(folder / name);
        EXPECT_LE(left.filename().string().size(), std::size_t(NAME_MAX));
        write_file(folder / name, std::string_view());
        EXPECT_FALSE(fs::exists(left));
        EXPECT_EQ(folder.files(), 1u);
        fs::remove(folder / name);
    }
    std::string umlauts;  // 255 bytes: a cut at the available 233 would be in the middle of a letter
    for (int i = 0; i < 127; ++i) umlauts += "\xc3\xb6";
    const PartFile part(folder / (umlauts + "x"));
    EXPECT_EQ(part.path().filename().string().substr(0, 233), "." + umlauts.substr(0, 232));
    EXPECT_EQ(part.path().filename().string()[233], '.');
}

// A process that removes a part file holds its lock; a part file made at the same moment is made again.
TEST(PartFile, ManyAtOnce) {
    const TestFolder folder;
    std::vector<pid_t> children;
    for (int i = 0; i < 4; ++i) {
        const pid_t id = fork();
        if (id == 0) {
            try {
                for (int n = 0; n < 200; ++n) {
                    TemporaryFile file(folder / "a.txt");
                    file.write("whole");
                    file.publish();
                }
                _exit(0);
            } catch (const RunError&) {
                _exit(1);
            }
        }
        children.push_back(id);
    }
    for (const pid_t id : children) {
        int status = 1;
        waitpid(id, &status, 0);
        EXPECT_EQ(status, 0);
    }
    EXPECT_EQ(read_text(folder / "a.txt"), "whole");
    EXPECT_EQ(folder.files(), 1u);
}

}  // namespace
}  // namespace tumble::part_file_test
