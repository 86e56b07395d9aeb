// Other programs: found, fed, read from, and their failures handled.
#include "output/process.h"
#include "core/error.h"

#include "support/folder.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <thread>

namespace tumble::process_test {
namespace {

const std::filesystem::path shell = "/bin/sh";

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

TEST(Process, ReadsItsInputAndEnds) {
    const TestFolder folder;
    Process process(shell, {"-c", "cat > \"$0\"", (folder / "out").string()});
    const std::string text(3'000'000, 'x');  // more than a pipe holds
    EXPECT_TRUE(process.write(bytes_of(text)));
    EXPECT_TRUE(process.finish().ok());
    EXPECT_EQ(read_text(folder / "out"), text);
}

// Memory is overwritten as soon as it is released: a slow program must have read it by then.
TEST(Process, LentMemoryIsHeldUntilItIsRead) {
    const TestFolder folder;
    const std::size_t size = (1 << 20) + 12345;  // slightly more than the pipe's capacity
    int kept = 0;
    const auto let_go = [&kept](std::byte* memory) {
        std::fill_n(memory, size, std::byte('!'));
        std::free(memory);
        --kept;
    };
    Process process(shell, {"-c", "sleep 0.05; exec dd of=\"$0\" bs=65536 2>/dev/null", (folder / "out").string()});
    std::string all;
    for (const char letter : {'a', 'b', 'c', 'd', 'e'}) {
        auto* const memory = static_cast<std::byte*>(std::aligned_alloc(4096, 2 << 20));
        std::fill_n(memory, size, std::byte(letter));
        all.append(size, letter);
        ++kept;
        EXPECT_TRUE(process.lend({memory, let_go}, size));
        EXPECT_EQ(kept, 1) << "memory of earlier writes was released";
    }
    EXPECT_TRUE(process.finish().ok());
    EXPECT_TRUE(read_text(folder / "out") == all);
}

TEST(Process, ItsFailureIsReported) {
    Process process(shell, {"-c", "echo first >&2; echo the reason >&2; exit 7"});
    const ProcessEnd end = process.finish();
    EXPECT_EQ(end.exit_code, 7);
    EXPECT_EQ(end.error_text, "first\nthe reason");
    EXPECT_EQ(end.describe(), "exit code 7");
}

TEST(Process, LongOutputIsCutToItsEnd) {
    Process process(shell, {"-c", "i=0; while [ $i -lt 20000 ]; do echo line $i; i=$((i+1)); done >&2; exit 1"});
    const ProcessEnd end = process.finish();
    EXPECT_LT(end.error_text.size(), 10000u);
    EXPECT_TRUE(end.error_text.ends_with("line 19999"));
}

TEST(Process, ADeadReaderRaisesNoSignal) {
    struct sigaction action {};
    sigaction(SIGPIPE, nullptr, &action);
    ASSERT_EQ(action.sa_handler, SIG_DFL) << "otherwise this test could not fail";
    Process process(shell, {"-c", "exec <&-; echo gone >&2; exit 3"});
    const std::string text(4'000'000, 'x');
    EXPECT_FALSE(process.write(bytes_of(text)));
    EXPECT_FALSE(process.write(bytes_of(text)));
    const ProcessEnd end = process.finish();
    EXPECT_EQ(end.exit_code, 3);
    EXPECT_EQ(end.error_text, "gone");
    sigset_t waiting;
    sigpending(&waiting);
    EXPECT_EQ(sigismember(&waiting, SIGPIPE), 0) << "the signal was left behind";
}

TEST(Process, CanBeKilledWhileItIsFed) {
    Process process("/bin/sleep", {"1000"});
    std::thread killer([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        process.kill();
    });
    const std::string text(8'000'000, 'x');  // sleep reads nothing: the write waits until the kill
    EXPECT_FALSE(process.write(bytes_of(text)));
    killer.join();
    const ProcessEnd end = process.finish();
    EXPECT_EQ(end.signal, SIGKILL);
    EXPECT_EQ(end.describe(), "ended by signal 9 (Killed)");
}

/// The number that the script wrote, after waiting for it.
pid_t number_in(const std::filesystem::path& file) {
    for (int i = 0; i < 10'000; ++i) {
        std::error_code missing;
        if (std::filesystem::exists(file, missing) && std::filesystem::file_size(file) > 0)
            return std::stoi(read_text(file));
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return -1;
}

// A zombie counts as gone as well, because the adopting process may be slow.
bool is_gone(pid_t id) {
    for (int i = 0; i < 10'000; ++i) {
        const std::filesystem::path status = "/proc/" + std::to_string(id) + "/stat";
        if (!std::filesystem::exists(status) || read_text(status).find(") Z ") != std::string::npos) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

// A process that a program leaves behind may hold its pipes open.
TEST(Process, ItsEndDoesNotWaitForItsChildren) {
    const TestFolder folder;
    const std::string leave_behind = "sleep 1000 & echo $! > \"$0\"; ";
    {
        Process process(shell, {"-c", leave_behind + "echo done >&2; exit 5", (folder / "a").string()});
        const ProcessEnd end = process.finish();
        EXPECT_EQ(end.exit_code, 5);
        EXPECT_EQ(end.error_text, "done");
    }
    {
        Process process(shell, {"-c", leave_behind + "exit 6", (folder / "b").string()});
        number_in(folder / "b");
        const std::string text(8'000'000, 'x');
        EXPECT_FALSE(process.write(bytes_of(text))) << "no one reads, but the pipe is open";
        EXPECT_EQ(process.finish().exit_code, 6);
    }
    EXPECT_EQ(output_of(shell, {"-c", leave_behind + "echo said", (folder / "c").string()}), "said\n");
    for (const char* name : {"a", "b", "c"}) {
        const pid_t id = number_in(folder / name);
        ASSERT_GT(id, 0);
        EXPECT_EQ(kill(id, SIGKILL), 0) << "it is left alone";
    }
}

TEST(Process, OneThatClosedItsErrorsIsWaitedForAndCanBeKilled) {
    Process quick(shell, {"-c", "exec 2>&-; sleep 0.1; exit 4"});
    EXPECT_EQ(quick.finish().exit_code, 4);

    Process slow(shell, {"-c", "exec 2>&-; exec sleep 1000"});
    std::thread killer([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        slow.kill();
    });
    EXPECT_EQ(slow.finish().signal, SIGKILL);
    killer.join();
}

// Without further input it would be waited for without end, and an interrupt would not be noticed.
TEST(Process, OneThatClosedItsInputAndErrorsIsEndedAfterASecond) {
    Process process(shell, {"-c", "exec <&- 2>&-; exec sleep 1000"});
    const std::string text(4'000'000, 'x');
    EXPECT_FALSE(process.write(bytes_of(text)));
    EXPECT_EQ(process.finish().signal, SIGKILL);
}

TEST(Process, KillingItKillsItsChildren) {
    const TestFolder folder;
    Process process(shell, {"-c", "sleep 1000 & echo $! > \"$0\"; sleep 1000", (folder / "child").string()});
    const pid_t child = number_in(folder / "child");
    ASSERT_GT(child, 0);
    process.kill();
    EXPECT_EQ(process.finish().signal, SIGKILL);
    EXPECT_TRUE(is_gone(child));
}

TEST(Process, ItsMessagesAreReadWhileItIsFed) {
    const TestFolder folder;
    const std::string script = "i=0; while [ $i -lt 30000 ]; do echo line $i; i=$((i+1)); done >&2; cat > \"$0\"";
    Process process(shell, {"-c", script, (folder / "out").string()});
    const std::string text(3'000'000, 'x');
    EXPECT_TRUE(process.write(bytes_of(text)));
    const ProcessEnd end = process.finish();
    EXPECT_TRUE(end.ok());
    EXPECT_TRUE(end.error_text.ends_with("line 29999"));
    EXPECT_EQ(read_text(folder / "out").size(), text.size());
}

TEST(Process, AProgramThatHangsIsStopped) {
    const TestFolder folder;
    int asked = 0;
    const ProgramOutput output =
        run_program(shell, {"-c", "sleep 1000 & echo $! | tee \"$0\"; sleep 1000", (folder / "child").string()},
                    [&] { return number_in(folder / "child") > 0 && ++asked > 2; });
    EXPECT_TRUE(output.stopped);
    EXPECT_EQ(output.end.signal, SIGKILL);
    EXPECT_EQ(output.text, read_text(folder / "child"));
    EXPECT_TRUE(is_gone(number_in(folder / "child")));

    EXPECT_FALSE(run_program("/bin/true", {}, [] { return false; }).stopped);
}

TEST(Process, ItsEndIsDetectedWithoutReapingIt) {
    const pid_t id = fork();
    if (id == 0) {
        ::pause();
        ::_exit(0);
    }
    EXPECT_FALSE(has_ended(id));
    EXPECT_FALSE(ends_within(id, std::chrono::milliseconds(30)));
    kill(id, SIGTERM);
    EXPECT_TRUE(ends_within(id, std::chrono::seconds(100)));
    EXPECT_TRUE(has_ended(id));
    EXPECT_EQ(wait_for_process(id).signal, SIGTERM);
}

TEST(Process, TheDestructorKillsIt) {
    const auto start = std::chrono::steady_clock::now();
    { const Process process("/bin/sleep", {"1000"}); }
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(100));
}

TEST(Process, ArgumentsReachItAsTheyAre) {
    EXPECT_EQ(output_of("/bin/echo", {"a b", "$HOME", "`x`", "*"}), "a b $HOME `x` *\n");
    EXPECT_EQ(output_of("/bin/false", {}), std::nullopt);
    EXPECT_EQ(output_of("/no/such/program", {}), std::nullopt);
    EXPECT_THROW(Process("/no/such/program", {}), RunError);
}

TEST(Process, ProgramsAreFoundByPath) {
    const TestFolder folder;
    write_text(folder / "tool", "#!/bin/sh\n");
    const std::string before = std::getenv("PATH");
    setenv("PATH", ((folder / "").string() + ":/nowhere").c_str(), 1);
    EXPECT_EQ(find_program("tool"), std::nullopt) << "it may not be run yet";
    std::filesystem::permissions(folder / "tool", std::filesystem::perms::owner_all);
    EXPECT_EQ(find_program("tool"), folder / "tool");
    EXPECT_EQ(find_program("sh"), std::nullopt);
    setenv("PATH", before.c_str(), 1);
}

}  // namespace
}  // namespace tumble::process_test
