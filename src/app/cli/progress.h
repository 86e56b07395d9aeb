// Progress of a run, on standard error: a bar on a terminal, otherwise a line every few seconds.
#pragma once

#include <cstdint>
#include <string>

namespace tumble {

class Progress {
public:
    /// Progress of `total` frames, or other `things`; `quiet` disables all output.
    Progress(std::int64_t total, bool quiet, const char* things = "frames");
    /// Erases the bar, so that the next message begins on a clean line.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Shows the number of finished frames, unless the last update was a moment ago. Cheap enough to call for every
    /// frame.
    void update(std::int64_t done);

private:
    void draw_bar(std::int64_t done, double now);
    void print_line(std::int64_t done, double now) const;
    std::string figures(std::int64_t done, double now) const;

    std::int64_t total_;
    const char* things_;
    bool quiet_, terminal_;
    double start_, last_shown_;
    bool bar_shown_ = false;
};

/// 75 s as "1:15", 4000 s as "1:06:40".
std::string clock_text(double seconds);

}  // namespace tumble
