#include "app/golden/child_tasks.h"

#include "core/check.h"
#include "core/child_process.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "output/process.h"

#include <fmt/format.h>

#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <exception>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace tumble {
namespace {

constexpr int poll_period = 50;           // ms between checks for an interrupt
constexpr char done = 'd', failed = 'f';  // the first byte of a child's text

TaskEnd end_of(const std::function<std::string()>& task) {
    try {
        return {true, task()};
    } catch (const InputError& error) {
        return {false, error.what()};
    } catch (const RunError& error) {
        return {false, error.what()};
    } catch (const std::bad_alloc&) {
        return {false, "error: out of memory"};
    } catch (const std::exception& error) {
        return {false, fmt::format("error: {}", safe_lines(error.what()))};
    }
}

/// A running child. Its destructor ends and reaps it.
class Child {
public:
    Child(std::size_t index, const std::function<std::string(std::size_t)>& task) : index_(index) {
        Pipe pipe;
        id_ = fork_child({.end_signal = SIGTERM, .own_group = false}, [&] {
            pipe.close_read();
            const TaskEnd end = end_of([&] { return task(index); });
            write_all(pipe.write_end(), (end.ok ? done : failed) + end.text);
            return 0;
        });
        pipe_ = pipe.take_read();
    }
    ~Child() {
        if (pipe_ >= 0) ::close(pipe_);
        if (id_ <= 0) return;
        ::kill(id_, SIGTERM);
        wait_for_process(id_);
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    std::size_t index() const { return index_; }
    int pipe() const { return pipe_; }

    /// Reads the waiting bytes; false at the end.
    bool read() {
        char block[4096];
        const ssize_t n = ::read(pipe_, block, sizeof block);
        if (n < 0) return errno == EINTR;
        text_.append(block, std::size_t(n));
        return n > 0;
    }
    TaskEnd finish() {
        const ProcessEnd end = wait_for_process(std::exchange(id_, -1));
        if (text_.empty()) return {false, fmt::format("error: its process ended without a result: {}", end.describe())};
        return {text_.front() == done, text_.substr(1)};
    }

private:
    std::size_t index_;
    pid_t id_ = -1;
    int pipe_ = -1;
    std::string text_;
};

}  // namespace

void run_in_children(std::size_t count, std::size_t at_once, const std::function<std::string(std::size_t)>& task,
                     const std::function<void(std::size_t, const TaskEnd&)>& ended, Interrupt& interrupt) {
    TUMBLE_CHECK_LT(std::size_t(0), at_once);
    std::vector<std::unique_ptr<Child>> children;
    for (std::size_t next = 0; next < count || !children.empty();) {
        while (next < count && children.size() < at_once) children.push_back(std::make_unique<Child>(next++, task));
        std::vector<pollfd> pipes;
        for (const auto& child : children) pipes.push_back({child->pipe(), POLLIN, 0});
        ::poll(pipes.data(), pipes.size(), poll_period);
        if (interrupt.pending()) throw Interrupted();
        for (std::size_t i = pipes.size(); i-- > 0;) {
            if (pipes[i].revents == 0 || children[i]->read()) continue;
            const std::size_t index = children[i]->index();
            const TaskEnd end = children[i]->finish();
            children.erase(children.begin() + std::ptrdiff_t(i));
            ended(index, end);
        }
    }
}

}  // namespace tumble
