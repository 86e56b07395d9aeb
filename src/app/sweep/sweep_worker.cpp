#include "app/sweep/sweep_worker.h"

#include "app/sweep/sample_maker.h"
#include "app/workers/worker_process.h"
#include "core/error.h"
#include "core/memory_limit.h"

#include <fmt/format.h>

#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <new>
#include <string_view>
#include <system_error>
#include <utility>

namespace tumble {
namespace {

constexpr auto longest_worker_end = std::chrono::seconds(1);  // of a worker without a job, which takes milliseconds

void set_reason(SampleReply& reply, std::string_view text) {
    reply.outcome = SampleReply::Outcome::failed;
    const std::size_t size = std::min(text.size(), reply.reason.size() - 1);
    std::copy_n(text.begin(), size, reply.reason.begin());
    reply.reason[size] = '\0';
}

SampleReply make_sample(SampleMaker& maker, const SampleJob& job) {
    SampleReply reply;
    reply.index = job.index;
    try {
        const auto known = job.anew ? SampleMaker::Known::made_anew : SampleMaker::Known::kept;
        reply.outcome = maker.make(job.index, known) ? SampleReply::Outcome::made : SampleReply::Outcome::kept;
    } catch (const std::bad_alloc&) {
        set_reason(reply, "out of memory");
    } catch (const std::exception& error) {
        set_reason(reply, reason_of(error));
    }
    return reply;
}

[[noreturn]] void work(const SweepTask& task, int socket) {
    try {
        SampleMaker maker(task.plan, task.scene, task.folder);
        SampleJob job;
        while (receive_message(socket, job))
            if (!send_message(socket, make_sample(maker, job))) break;
    } catch (const std::exception& error) {
        std::fputs(error.what(), stderr);
        ::_exit(1);
    }
    ::_exit(0);  // no destructors of the parent's objects, no second flush of its streams
}

}  // namespace

SweepWorker::SweepWorker(const SweepTask& task, std::span<const int> other_sockets) {
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0)
        throw RunError("cannot make a socket: " + std::generic_category().message(errno));
    std::fflush(nullptr);
    const pid_t program = ::getpid();
    id_ = ::fork();
    if (id_ == 0) {
        become_worker(program);
        ::close(ends[0]);
        for (const int socket : other_sockets) ::close(socket);
        work(task, ends[1]);
    }
    const int error = errno;
    ::close(ends[1]);
    socket_ = ends[0];
    if (id_ < 0) {
        ::close(socket_);
        throw RunError("cannot start a process for samples: " + std::generic_category().message(error));
    }
}

SweepWorker::~SweepWorker() {
    if (id_ >= 0) ::kill(id_, SIGKILL);
    finish();
}

void SweepWorker::give(const SampleJob& job) {
    job_ = job;
    send_message(socket_, job);  // if it has died, receive() says so
}

SampleReply SweepWorker::receive() {
    SampleReply reply;
    const std::int64_t index = job_ ? job_->index : -1;
    job_.reset();
    if (receive_message(socket_, reply)) return reply;
    reply.index = index;
    ::close(std::exchange(socket_, -1));
    const ProcessEnd end = wait_for_process(std::exchange(id_, -1));
    set_reason(reply, fmt::format("its process {}{}", end.describe(), memory_limit_note()));
    return reply;
}

void SweepWorker::finish() {
    if (socket_ >= 0) ::close(std::exchange(socket_, -1));  // the worker takes the closed socket as the end of its jobs
    if (id_ < 0) return;
    if (!ends_within(id_, longest_worker_end)) ::kill(id_, SIGKILL);
    wait_for_process(std::exchange(id_, -1));
}

}  // namespace tumble
