#include "app/sweep/sweep_worker.h"

#include "app/sweep/sample_maker.h"
#include "core/available_memory.h"
#include "core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string_view>

namespace tumble {
namespace {

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
        set_reason(reply, reason_of(error.what()));
    }
    return reply;
}

/// In the worker. Returns its exit code.
int make_samples(const SweepTask& task, int socket) {
    try {
        SampleMaker maker(task.plan, task.scene, task.folder);
        SampleJob job;
        while (receive_message(socket, job))
            if (!send_message(socket, make_sample(maker, job))) break;
    } catch (const std::exception& error) {
        std::fputs(error.what(), stderr);
        return 1;
    }
    return 0;
}

}  // namespace

SweepWorker::SweepWorker(const SweepTask& task, std::span<const int> other_sockets)
    : process_("samples", other_sockets, [&](int socket) { return make_samples(task, socket); }) {}

void SweepWorker::give(const SampleJob& job) {
    job_ = job;
    send_message(process_.socket(), job);  // if it has died, receive() says so
}

SampleReply SweepWorker::receive() {
    SampleReply reply;
    const std::int64_t index = job_ ? job_->index : -1;
    job_.reset();
    if (receive_message(process_.socket(), reply)) return reply;
    reply.index = index;
    set_reason(reply, fmt::format("its process {}{}", process_.finish().describe(), memory_limit_note()));
    return reply;
}

}  // namespace tumble
