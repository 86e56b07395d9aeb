// A trace of a run: which stage worked when, in each thread. A thread that serves a render process shows its work. The
// file is in the Chrome trace format (JSON, "X" and "M" events), which Perfetto and chrome://tracing show.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace tumble {

struct TraceSpan {
    const char* name = "";          // of the stage; lives as long as the trace
    double start = 0.0, end = 0.0;  // s of wall_seconds(), which all processes of a machine share
    std::int64_t frame = -1;        // -1: of no frame
};

class Trace {
public:
    /// On the row of the calling thread, which is named after its first span. From any thread.
    void add(const TraceSpan& span);
    /// On a row of that name, for work of another program.
    void add(const TraceSpan& span, const std::string& row);

    /// Throws RunError.
    void write(const std::filesystem::path& file) const;

private:
    struct Placed {
        TraceSpan span;
        std::size_t row;
    };
    std::size_t make_row(const std::string& name);

    mutable std::mutex mutex_;
    std::map<std::thread::id, std::size_t> rows_;
    std::vector<std::string> row_names_;  // all differ
    std::vector<Placed> spans_;
};

}  // namespace tumble
