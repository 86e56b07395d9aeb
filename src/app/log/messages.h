// Messages of a run for its user. As text they go to standard error; as JSON each is an object on a line of its own, on
// a descriptor of choice, for programs that watch the run (docs/reference/log.md).
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <exception>
#include <string_view>

namespace tumble {

/// True if the input is wrong, and not the run: exit code 2.
bool is_input_error(const std::exception& error);

struct ProgressFigures {
    std::int64_t done = 0, total = 0;
    const char* things = "frames";
    double seconds = 0.0;  // wall clock, since the first one was begun
};

class Messages {
public:
    Messages();
    Messages(const Messages&) = delete;
    Messages& operator=(const Messages&) = delete;

    /// JSON from now on. Throws InputError if the descriptor cannot be written.
    void write_json_to(int descriptor);
    bool json() const { return json_to_ >= 0; }

    /// Whole lines. A failure of the write has no effect. As JSON: an event "message" for each line.
    void say_text(std::string_view text);

    /// The last message of a run that fails; as text, the words of the exception.
    void fail(const std::exception& error);

    /// Only as JSON: `members` follow the name of the event and its time.
    void event(std::string_view name, const nlohmann::ordered_json& members);
    void progress(const ProgressFigures& figures);
    void end(int exit_code);

private:
    int json_to_ = -1;
    double start_;  // s, of a monotonic clock
};

}  // namespace tumble
