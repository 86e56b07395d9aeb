#include "app/cli/progress.h"

#include "app/cli/say.h"
#include "app/threads/stage_timer.h"

#include <fmt/format.h>

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr double bar_period = 0.1;    // s between updates of the bar
constexpr double line_period = 5.0;   // s between lines of a log
constexpr double event_period = 1.0;  // s between events of a log in JSON

int terminal_columns() {
    winsize size{};
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
    return size.ws_col;
}

}  // namespace

std::string clock_text(double seconds) {
    const auto s = static_cast<long long>(std::llround(std::min(std::max(seconds, 0.0), 1e9)));
    if (s < 3600) return fmt::format("{}:{:02}", s / 60, s % 60);
    return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
}

Progress::Progress(std::int64_t total, bool quiet, const char* things)
    : total_(total),
      things_(things),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) == 1),
      start_(wall_seconds()),
      last_shown_(start_) {}

Progress::~Progress() {
    if (bar_shown_) say_text("\r\033[K");
}

void Progress::update(std::int64_t done) {
    if (quiet_) return;
    const double now = wall_seconds();
    const bool json = messages().json();
    if (now - last_shown_ < (json ? event_period : terminal_ ? bar_period : line_period)) return;
    last_shown_ = now;
    if (json)
        messages().progress({done, total_, things_, now - start_});
    else if (terminal_)
        draw_bar(done, now);
    else
        print_line(done, now);
}

std::string Progress::figures(std::int64_t done, double now) const {
    const double rate = double(done) / (now - start_);
    std::string text = fmt::format("{} of {} {}, {:.1f} {}/s", done, total_, things_, rate, things_);
    if (done > 0) text += fmt::format(", {} left", clock_text(double(total_ - done) / rate));
    return text;
}

void Progress::draw_bar(std::int64_t done, double now) {
    const double part = total_ > 0 ? double(done) / double(total_) : 1.0;
    const std::string text = fmt::format(" {:3.0f} %  {}", 100.0 * part, figures(done, now));
    const int width = std::min(40, terminal_columns() - int(text.size()) - 3);  // one column stays free: no line break
    std::string bar;
    if (width >= 5) {
        const int full = int(part * width);
        bar = fmt::format("[{:#<{}}{:.<{}}]", "", full, "", width - full);
    }
    say_text("\r" + bar + text + "\033[K");
    bar_shown_ = true;
}

void Progress::print_line(std::int64_t done, double now) const { say_text(figures(done, now) + "\n"); }

}  // namespace tumble
