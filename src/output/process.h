// Another program, run with a vector of arguments (no shell in between), fed through its standard input.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

namespace tumble {

/// Where the program of that name is, by PATH; nothing if it is nowhere.
std::optional<std::filesystem::path> find_program(const std::string& name);

/// How a program ended.
struct ProcessEnd {
    int exit_code = -1;          // 0 to 255; -1: ended by a signal
    int signal = 0;
    double cpu_seconds = 0.0;    // user and system
    std::int64_t peak_memory = 0;   // bytes
    std::string words;           // the last of what it wrote to standard error, without trailing newlines
    bool ok() const { return exit_code == 0; }
    std::string describe() const;   // "exit code 1", "ended by signal 9 (Killed)"
};

/// Waits for the end of a child.
ProcessEnd wait_for_process(pid_t id);

/// A running program. It has its own process group, so that Ctrl-C reaches it only through us.
class Process {
public:
    /// Starts it; standard output goes to a descriptor, or nowhere. Throws RunError when it cannot be started.
    Process(const std::filesystem::path& program, const std::vector<std::string>& arguments,
            std::optional<int> output = std::nullopt);
    /// A program that still runs is killed.
    ~Process();
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    /// Writes all the bytes to its standard input; false when it no longer reads. Never raises SIGPIPE.
    bool write(std::span<const std::byte> bytes);

    /// The same, but its pages go into the pipe themselves, in place of copies, where that holds fewer bytes: they must not
    /// change while the pointer is kept, which is until the program has read them, with read() as most do (one that hands
    /// pages on by splice() may still have them).
    bool lend(std::shared_ptr<const std::byte> memory, std::size_t size);

    /// Ends its input and waits for its end.
    ProcessEnd finish();

    /// Asks it to end at once; finish() then tells how it did. May be called from another thread.
    void kill();

private:
    void keep_words();

    pid_t id_ = -1;
    std::mutex id_mutex_;        // kill() against the wait in finish()
    int input_ = -1;
    std::shared_ptr<const std::byte> lent_;   // may be in the pipe
    int words_pipe_ = -1;
    std::string words_;
    std::thread words_reader_;
};

/// Runs a program to its end and returns the start of its standard output; nothing if it cannot run or fails.
std::optional<std::string> output_of(const std::filesystem::path& program, const std::vector<std::string>& arguments);

}  // namespace tumble
