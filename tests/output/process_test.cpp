// Other programs: found, fed, listened to, and their deaths survived.
#include "core/error.h"
#include "output/process.h"

#include "../support/folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <thread>

namespace tumble {
namespace {

const std::filesystem::path shell = "/bin/sh";

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

TEST(Process, IsFedAndEnds) {
    const TestFolder folder;
    Process process(shell, {"-c", "cat > \"$0\"", (folder / "out").string()});
    const std::string text(3'000'000, 'x');   // more than a pipe holds
    EXPECT_TRUE(process.write(bytes_of(text)));
    EXPECT_TRUE(process.finish().ok());
    EXPECT_EQ(read_text(folder / "out"), text);
}

// Memory is written over as soon as it is let go of: a program that is slow to read must have read it by then.
TEST(Process, WhatIsLentIsKeptUntilItIsRead) {
    const TestFolder folder;
    const std::size_t size = (1 << 20) + 12345;   // a little more than the pipe holds
    int kept = 0;
    const auto let_go = [&kept](std::byte* memory) {
        std::fill_n(memory, size, std::byte('!'));
        std::free(memory);
        --kept;
    };
    Process process(shell, {"-c", "sleep .05; exec dd of=\"$0\" bs=65536 2>/dev/null", (folder / "out").string()});
    std::string all;
    for (const char letter : {'a', 'b', 'c', 'd', 'e'}) {
        auto* const memory = static_cast<std::byte*>(std::aligned_alloc(4096, 2 << 20));
        std::fill_n(memory, size, std::byte(letter));
        all.append(size, letter);
        ++kept;
        EXPECT_TRUE(process.lend({memory, let_go}, size));
        EXPECT_EQ(kept, 1) << "what came before is in nobody's way";
    }
    EXPECT_TRUE(process.finish().ok());
    EXPECT_TRUE(read_text(folder / "out") == all);
}

TEST(Process, ItsFailureIsTold) {
    Process process(shell, {"-c", "echo first >&2; echo the reason >&2; exit 7"});
    const ProcessEnd end = process.finish();
    EXPECT_EQ(end.exit_code, 7);
    EXPECT_EQ(end.words, "first\nthe reason");
    EXPECT_EQ(end.describe(), "exit code 7");
}

TEST(Process, ManyWordsAreCutToTheLast) {
    Process process(shell, {"-c", "i=0; while [ $i -lt 20000 ]; do echo line $i; i=$((i+1)); done >&2; exit 1"});
    const ProcessEnd end = process.finish();
    EXPECT_LT(end.words.size(), 10000u);
    EXPECT_TRUE(end.words.ends_with("line 19999"));
}

TEST(Process, AReaderThatDiesIsNoSignalForUs) {
    struct sigaction action {};
    sigaction(SIGPIPE, nullptr, &action);
    ASSERT_EQ(action.sa_handler, SIG_DFL) << "else this test could not fail";
    Process process(shell, {"-c", "exec <&-; echo gone >&2; exit 3"});
    const std::string text(4'000'000, 'x');
    EXPECT_FALSE(process.write(bytes_of(text)));
    EXPECT_FALSE(process.write(bytes_of(text)));
    const ProcessEnd end = process.finish();
    EXPECT_EQ(end.exit_code, 3);
    EXPECT_EQ(end.words, "gone");
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
    const std::string text(8'000'000, 'x');   // sleep reads nothing: the write waits until the kill
    EXPECT_FALSE(process.write(bytes_of(text)));
    killer.join();
    const ProcessEnd end = process.finish();
    EXPECT_EQ(end.signal, SIGKILL);
    EXPECT_EQ(end.describe(), "ended by signal 9 (Killed)");
}

TEST(Process, ForgottenItIsKilled) {
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
}  // namespace tumble
