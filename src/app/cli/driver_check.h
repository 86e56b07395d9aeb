// Checks of programs, drivers and libraries in processes of their own: one that crashes or hangs is a finding as well.
#pragma once

#include "app/threads/interrupt.h"
#include "app/threads/stage_timer.h"
#include "output/process.h"
#include "render/renderer.h"

#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tumble {

struct Finding {
    bool good = false;
    std::string text;
    bool can_be_installed = true;  // true if an installation is the remedy
};

/// Waits for child processes until they end, the time limit is reached, or Ctrl-C is pressed.
class TimeLimit {
public:
    explicit TimeLimit(double limit) : limit_(limit) {}

    ProgramOutput run(const std::filesystem::path& program, const std::vector<std::string>& arguments) {
        return run_program(program, arguments, stop());
    }
    ProgramOutput listen(pid_t id, int pipe) { return listen_to(id, pipe, stop()); }

    bool interrupted() const { return interrupted_; }

    /// The finding for a child that was stopped.
    Finding late(const std::string& what) const {
        return {false, fmt::format("{} does not answer (ended after {:g} s)", what, limit_), false};
    }

private:
    std::function<bool()> stop() {
        return [this, end = wall_seconds() + limit_] {
            interrupted_ = interrupted_ || interrupt_.pending();
            return interrupted_ || wall_seconds() >= end;
        };
    }

    double limit_;  // s
    Interrupt interrupt_;
    bool interrupted_ = false;
};

/// Runs `check` in a process of its own: a library that crashes or hangs is a finding as well.
/// The text that `check` returns is the text of a good finding; an exception makes a bad one.
Finding in_own_process(const char* library, const std::function<std::string()>& check, TimeLimit& time_limit);

/// Draws an empty scene of a few pixels; the text of a good finding is the driver's own name.
Finding try_drawing(GlBackend backend, TimeLimit& time_limit);

}  // namespace tumble
