// How far a run is: a bar on a terminal, a plain line now and then elsewhere. On standard error.
#pragma once

#include <cstdint>
#include <string>

namespace tumble {

class Progress {
public:
    /// Of `total` frames; a quiet one says nothing.
    Progress(std::int64_t total, bool quiet);
    /// Takes the bar away, so that what is said next begins on a clean line.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Says how many frames are done, if it was not said a moment ago. Cheap enough for every frame.
    void update(std::int64_t done);

private:
    void draw_bar(std::int64_t done, double now);
    void print_line(std::int64_t done, double now) const;
    std::string figures(std::int64_t done, double now) const;

    std::int64_t total_;
    bool quiet_, terminal_;
    double start_, last_shown_;
    bool bar_shown_ = false;
};

/// 75 s as "1:15", 4000 s as "1:06:40".
std::string clock_text(double seconds);

}  // namespace tumble
