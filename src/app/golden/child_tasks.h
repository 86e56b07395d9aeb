// Tasks in processes of their own, several at a time: each may start render processes, which needs a program without
// threads.
#pragma once

#include "app/threads/interrupt.h"

#include <cstddef>
#include <functional>
#include <string>

namespace tumble {

/// End of a task: its result, or the text of its error.
struct TaskEnd {
    bool ok = false;
    std::string text;
};

/// Runs `task(i)` for each i below `count`, up to `at_once` at a time, each in a child; its text is the result. `ended`
/// is called in this process, in the order of the ends. Precondition: the program has no other thread. Throws RunError
/// after an interrupt, or if no process can be started; all children have then ended.
void run_in_children(std::size_t count, std::size_t at_once, const std::function<std::string(std::size_t)>& task,
                     const std::function<void(std::size_t, const TaskEnd&)>& ended, Interrupt& interrupt);

}  // namespace tumble
