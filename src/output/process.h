// Another program, run with a vector of arguments (no shell in between), fed through its standard input.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
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

/// Has the child ended? Its end is not taken: wait_for_process() tells it.
bool has_ended(pid_t id);
/// Waits for its end, but no longer than that.
bool ends_within(pid_t id, std::chrono::milliseconds limit);

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

    /// Ends its input and waits for its end; for a second only where it read no more before that, and then kills it. Processes that it started and left behind are not waited for.
    ProcessEnd finish();

    /// Ends it at once, with all processes of its group; finish() then tells how it did. May be called from another thread.
    void kill();

private:
    void read_words();
    bool wait_for_room();        // in its input; false: it has ended

    pid_t id_ = -1;
    std::mutex id_mutex_;        // kill() against the end of finish(), after which another process may have that number
    int input_ = -1;
    std::shared_ptr<const std::byte> lent_;   // may be in the pipe
    bool reads_no_more_ = false;   // before its input ended
    int words_pipe_ = -1;        // -1: closed, after all has been read
    std::string words_;
};

/// What came of a child that was listened to.
struct ProgramOutput {
    std::string text;       // the start of what it wrote
    ProcessEnd end;
    bool stopped = false;   // it was killed, because it was asked to stop
};

/// Reads what a child writes into a pipe, until the child ends. `stop` is asked every few milliseconds: once it says true,
/// the child's process group is killed.
ProgramOutput listen_to(pid_t id, int pipe, const std::function<bool()>& stop);

/// Runs a program, in a process group of its own, with nothing to read, and listens to its standard output. Throws RunError
/// when it cannot be started.
ProgramOutput run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                          const std::function<bool()>& stop);

/// Runs a program to its end and returns the start of its standard output; nothing if it cannot run or fails.
std::optional<std::string> output_of(const std::filesystem::path& program, const std::vector<std::string>& arguments);

}  // namespace tumble
