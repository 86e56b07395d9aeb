// A file appears completely or not at all, and an earlier file stays until then.
#include "output/temporary_file.h"
#include "core/error.h"
#include "output/png_writer.h"

#include "support/folder.h"
#include "support/pictures.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <string>

namespace tumble::temporary_file_test {
namespace {

TEST(TemporaryFile, AppearsAtCommit) {
    const TestFolder folder;
    write_text(folder / "a.txt", "old");
    {
        TemporaryFile file(folder / "a.txt");
        file.write("new");
        EXPECT_EQ(read_text(folder / "a.txt"), "old");
        EXPECT_EQ(file.path().filename().string().front(), '.');
        file.commit();
    }
    EXPECT_EQ(read_text(folder / "a.txt"), "new");
    EXPECT_EQ(folder.files(), 1u);
}

TEST(TemporaryFile, WithoutCommitNothingIsLeft) {
    const TestFolder folder;
    write_text(folder / "a.txt", "old");
    {
        TemporaryFile file(folder / "a.txt");
        file.write("new");
    }
    EXPECT_EQ(read_text(folder / "a.txt"), "old");
    EXPECT_EQ(folder.files(), 1u);
}

TEST(TemporaryFile, ALinkIsWrittenThrough) {
    const TestFolder folder;
    write_text(folder / "a.txt", "old");
    std::filesystem::create_symlink(folder / "a.txt", folder / "link.txt");
    TemporaryFile file(folder / "link.txt");
    file.write("new");
    file.commit();
    EXPECT_EQ(read_text(folder / "a.txt"), "new");
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
}

TEST(TemporaryFile, ALinkToAMissingFileIsWrittenThrough) {
    const TestFolder folder;
    std::filesystem::create_directory(folder / "in");
    // through another link, each relative to its own folder
    std::filesystem::create_symlink("in/other.txt", folder / "link.txt");
    std::filesystem::create_symlink("../a.txt", folder / "in/other.txt");
    TemporaryFile file(folder / "link.txt");
    file.write("new");
    file.commit();
    EXPECT_EQ(read_text(folder / "a.txt"), "new");
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "in/other.txt"));
}

TEST(TemporaryFile, LinkLoopsAreRefused) {
    const TestFolder folder;
    std::filesystem::create_symlink("b", folder / "a");
    std::filesystem::create_symlink("a", folder / "b");
    EXPECT_THROW(TemporaryFile(folder / "a"), InputError);
    EXPECT_EQ(folder.files(), 2u);
}

TEST(TemporaryFile, ADescriptorIsWrittenAtItsPosition) {
    const TestFolder folder;
    write_text(folder / "log", "old ");
    const int log = ::open((folder / "log").c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
    ASSERT_GE(log, 0);
    const std::string name = "/dev/fd/" + std::to_string(log);
    std::filesystem::create_symlink(name, folder / "link");
    for (const std::filesystem::path& path : {std::filesystem::path(name), folder / "link"}) {
        TemporaryFile file(path);
        EXPECT_EQ(file.descriptor(), log);
        file.write("new ");
        file.commit();
    }
    ::close(log);
    EXPECT_EQ(read_text(folder / "log"), "old new new ");
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
    EXPECT_THROW(TemporaryFile{name}, RunError);
}

TEST(TemporaryFile, ErrorsNameTheFinalFile) {
    const TestFolder folder;
    write_text(folder / "file", "");
    for (const auto& path : {folder / "missing/a.png", folder / "file/a.png", folder / "."}) {
        try {
            write_png(path, colorful(2, 2));
            FAIL() << path;
        } catch (const RunError& error) {
            EXPECT_NE(std::string(error.what()).find("cannot write '" + path.string() + "'"), std::string::npos)
                << error.what();
        }
    }
    EXPECT_EQ(folder.files(), 1u);
}

TEST(TemporaryFile, ADeviceIsWrittenInPlace) {
    TemporaryFile null("/dev/null");
    null.write("gone");
    null.commit();
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
    EXPECT_THROW(
        {
            TemporaryFile full("/dev/full");
            full.write("no room");
        },
        RunError);
}

TEST(TemporaryFile, AFullDiskLeavesNothing) {
    const TestFolder folder;
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const auto previous = std::signal(SIGXFSZ, SIG_IGN);
    rlimit small = before;
    small.rlim_cur = 1000;  // bytes in a file: for the writer, the same error as a full disk
    setrlimit(RLIMIT_FSIZE, &small);
    EXPECT_THROW(write_png(folder / "a.png", colorful(320, 180)), RunError);
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, previous);
    EXPECT_EQ(folder.files(), 0u);
}

}  // namespace
}  // namespace tumble::temporary_file_test
