// Bounds of memory: folders like those of the system, and this process's true address space.
#include "core/available_memory.h"
#include "core/error.h"

#include "support/folder.h"

#include <gtest/gtest.h>

#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

namespace tumble::available_memory_test {
namespace {

constexpr std::uint64_t mebi = 1 << 20, gibi = 1 << 30;

/// A machine with 8 GiB free and 1 GiB of swap.
class AvailableMemoryTest : public testing::Test {
protected:
    void write(const std::string& path, const std::string& text) {
        std::filesystem::create_directories((folder / path).parent_path());
        write_text(folder / path, text);
    }
    void SetUp() override {
        write("proc/meminfo",
              "MemTotal: 16777216 kB\nMemFree: 1024 kB\nMemAvailable: 8388608 kB\nSwapFree: 1048576 kB\n");
    }
    AvailableMemory available() const { return available_memory({folder / "proc", folder / "groups"}); }

    TestFolder folder;
};

TEST_F(AvailableMemoryTest, TheMachine) {
    EXPECT_EQ(available().bytes, 9 * gibi);
    EXPECT_EQ(available().bound, "the machine");
}

TEST_F(AvailableMemoryTest, AControlGroupOfVersion2) {
    write("proc/self/cgroup", "0::/outer/inner\n");
    write("groups/outer/inner/memory.max", "max\n");
    write("groups/outer/inner/memory.current", "1000\n");
    write("groups/outer/memory.max", "1073741824\n");  // the parent's limit counts as well
    write("groups/outer/memory.current", "734003200\n");
    write("groups/outer/memory.stat", "anon 5\ninactive_file 104857600\nactive_file 209715200\n");
    EXPECT_EQ(available().bytes, (1024 - 700 + 100 + 200) * mebi);
    EXPECT_NE(available().bound.find("control group"), std::string_view::npos);
    write("groups/outer/memory.current", "2147483648\n");
    EXPECT_EQ(available().bytes, 0u) << "used beyond the limit";
}

TEST_F(AvailableMemoryTest, AControlGroupOfVersion1) {
    write("proc/self/cgroup", "9:name=systemd:/\n4:cpu,memory:/job\n0::/\n");
    write("groups/memory/job/memory.limit_in_bytes", "536870912\n");
    write("groups/memory/job/memory.usage_in_bytes", "104857600\n");
    EXPECT_EQ(available().bytes, 412 * mebi);
    EXPECT_EQ(shared_memory({folder / "proc", folder / "groups"}).bytes, 412 * mebi);
    write("groups/memory/job/memory.limit_in_bytes", "9223372036854771712\n");  // none
    EXPECT_EQ(available().bytes, 9 * gibi);
}

TEST_F(AvailableMemoryTest, AContainerSeesItsGroupAsTheRoot) {
    write("proc/self/cgroup", "0::/elsewhere/that/is/not/mounted\n");
    write("groups/memory.max", "1073741824\n");
    write("groups/memory.current", "0\n");
    EXPECT_EQ(available().bytes, gibi);
}

TEST_F(AvailableMemoryTest, UnknownValuesAreNoBounds) {
    EXPECT_GT(available_memory({folder / "none", folder / "none"}).bytes, 1000 * gibi);
}

/// Ends the process: 7 if the limit of its address space is detected.
void look_at_address_space() {
    std::uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    rlimit limit{};
    limit.rlim_cur = limit.rlim_max = pages * std::uint64_t(getpagesize()) + 64 * mebi;
    setrlimit(RLIMIT_AS, &limit);
    const AvailableMemory left = available_memory();
    const bool seen = shared_memory().bytes > left.bytes && left.bytes <= 64 * mebi &&
                      left.bound.find("ulimit -v") != std::string_view::npos;
    std::exit(seen ? 7 : 8);
}

TEST(AvailableMemoryDeathTest, TheAddressSpace) {
    EXPECT_EXIT(look_at_address_space(), testing::ExitedWithCode(7), "");
}

TEST(AvailableMemory, SmallRequestsPassAndLargeOnesAreRefusedWithNumbers) {
    require_memory(1, "nothing", "none");
    try {
        require_memory(std::uint64_t(1) << 60, "a picture of 9 x 9 pixels", "a smaller one takes less");
        FAIL();
    } catch (const RunError& error) {
        const std::string words = error.what();
        EXPECT_NE(words.find("a picture of 9 x 9 pixels takes 1.07e+09 GiB of memory, and "), std::string::npos)
            << words;
        EXPECT_NE(words.find(" left; a smaller one takes less"), std::string::npos) << words;
    }
    EXPECT_EQ(memory_text(300 * mebi), "300 MiB");
    EXPECT_EQ(memory_text(1020 * mebi), "0.996 GiB");
    EXPECT_EQ(memory_text(7 * gibi + gibi / 2), "7.5 GiB");
}

}  // namespace
}  // namespace tumble::available_memory_test
