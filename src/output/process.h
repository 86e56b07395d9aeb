// Runs another program with a vector of arguments (without a shell) and feeds its standard input.
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

/// Path of the program of that name, from PATH; empty if it is not found.
std::optional<std::filesystem::path> find_program(const std::string& name);

/// End of a program.
struct ProcessEnd {
    int exit_code = -1;  // 0 to 255; -1: ended by a signal
    int signal = 0;
    double cpu_seconds = 0.0;      // user and system
    std::int64_t peak_memory = 0;  // bytes
    std::string error_text;        // last part of its standard error, without trailing newlines
    bool ok() const { return exit_code == 0; }
    std::string describe() const;  // "exit code 1", "ended by signal 9 (Killed)"
};

/// Waits for the end of a child.
ProcessEnd wait_for_process(pid_t id);

/// True if the child has ended. It is not reaped: wait_for_process() returns its end.
bool has_ended(pid_t id);
/// Waits for its end, but not longer than `limit`.
bool ends_within(pid_t id, std::chrono::milliseconds limit);

/// A running program. It has its own process group, so that Ctrl-C reaches it only through this process.
class Process {
public:
    /// Starts it; standard output goes to a descriptor, or is dropped. Throws RunError if it cannot be started.
    Process(const std::filesystem::path& program, const std::vector<std::string>& arguments,
            std::optional<int> output = std::nullopt);
    /// Kills a program that still runs.
    ~Process();
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;

    /// Writes all bytes to its standard input; false if it no longer reads. Never raises SIGPIPE.
    bool write(std::span<const std::byte> bytes);

    /// The same, but passes memory pages into the pipe instead of copies, if the pipe's capacity is smaller.
    /// Precondition: they do not change while the pointer is held, which is until the program has read them with
    /// read(). (A program that passes pages on with splice() may still hold them.)
    bool lend(std::shared_ptr<const std::byte> memory, std::size_t size);

    /// Takes the messages on its standard error that are waiting, so that it need not wait for room. Call it from time
    /// to time while its output is read.
    void take_messages() { read_error_text(); }

    /// Closes its input and waits for its end. If it stopped reading before that, it is killed after a second.
    /// Processes that it started are not waited for.
    ProcessEnd finish();

    /// Kills it at once, with all processes of its group; finish() then returns its end. May be called from another
    /// thread.
    void kill();

private:
    void read_error_text();
    bool wait_for_room();  // in its input; false: it has ended

    pid_t id_ = -1;
    std::mutex
        id_mutex_;  // guards kill() against the end of finish(), after which another process may have that number
    int input_ = -1;
    std::shared_ptr<const std::byte> lent_;  // may be in the pipe
    bool reads_no_more_ = false;             // it stopped before its input ended
    int error_pipe_ = -1;                    // -1: closed, after all data was read
    std::string error_text_;
};

/// Output and end of a child.
struct ProgramOutput {
    std::string text;  // first part of its output
    ProcessEnd end;
    bool stopped = false;  // it was killed, because `stop` returned true
};

/// Reads a child's output from a pipe until the child ends. `stop` is called every few milliseconds; if it returns
/// true, the child's process group is killed.
ProgramOutput listen_to(pid_t id, int pipe, const std::function<bool()>& stop);

/// Runs a program in its own process group, without input, and reads its standard output. Throws RunError if it cannot
/// be started.
ProgramOutput run_program(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                          const std::function<bool()>& stop);

/// Runs a program to its end and returns the first part of its standard output; empty if it cannot run or fails.
std::optional<std::string> output_of(const std::filesystem::path& program, const std::vector<std::string>& arguments);

}  // namespace tumble
