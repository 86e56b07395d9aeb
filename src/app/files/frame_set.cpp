#include "app/files/frame_set.h"

#include "core/check.h"
#include "core/error.h"
#include "core/safe_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace tumble {
namespace {

/// A piece of a range expression: first, first + step ... up to last.
struct Piece {
    std::int64_t first, last, step;
    std::string_view text;
};

[[noreturn]] void fail_range(const std::string& why) { throw InputError("--frames-range: " + why); }

std::int64_t read_frame_number(std::string_view text, std::string_view piece) {
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error == std::errc::result_out_of_range) fail_range(fmt::format("'{}' is too large", safe_text(text)));
    if (text.empty() || error != std::errc() || end != text.data() + text.size() || text.front() == '-')
        fail_range(fmt::format("must be frames from 0, as in 7, 1-10 or 30-40:2, with commas between them (given '{}')",
                               safe_text(piece)));
    return number;
}

std::string_view without_spaces(std::string_view text) {
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    return text;
}

Piece read_piece(std::string_view text) {
    const std::size_t colon = text.find(':');
    const std::string_view range = text.substr(0, colon);
    const std::size_t dash = range.find('-', 1);
    Piece piece{
        .first = read_frame_number(without_spaces(range.substr(0, dash)), text), .last = 0, .step = 1, .text = text};
    piece.last =
        dash == std::string_view::npos ? piece.first : read_frame_number(without_spaces(range.substr(dash + 1)), text);
    if (colon != std::string_view::npos) {
        if (dash == std::string_view::npos)
            fail_range(fmt::format("a step needs a range, as in 30-40:2 (given '{}')", safe_text(text)));
        piece.step = read_frame_number(without_spaces(text.substr(colon + 1)), text);
        if (piece.step == 0) fail_range(fmt::format("a step must be at least 1 (given '{}')", safe_text(text)));
    }
    if (piece.last < piece.first)
        fail_range(fmt::format("a range must ascend: {}-{} (given '{}')", piece.last, piece.first, safe_text(text)));
    piece.last -= (piece.last - piece.first) % piece.step;
    return piece;
}

}  // namespace

void FrameSet::append(std::int64_t first, std::int64_t end) {
    if (first >= end) return;
    TUMBLE_CHECK_GE(first, this->end());
    if (!runs_.empty() && runs_.back().end == first)
        runs_.back().end = end;
    else
        runs_.push_back({first, end});
    count_ += end - first;
}

bool FrameSet::contains(std::int64_t frame) const {
    const auto run = std::ranges::upper_bound(runs_, frame, {}, &Run::first);
    return run != runs_.begin() && frame < std::prev(run)->end;
}

std::int64_t FrameSet::after(std::int64_t frame) const {
    if (contains(frame + 1)) return frame + 1;
    const auto run = std::ranges::upper_bound(runs_, frame, {}, &Run::first);
    return run == runs_.end() ? end() : run->first;
}

void FrameSet::for_each(const std::function<void(std::int64_t)>& use) const {
    for (const Run& run : runs_)
        for (std::int64_t n = run.first; n < run.end; ++n) use(n);
}

FrameSet FrameSet::where(const std::function<bool(std::int64_t)>& wanted) const {
    FrameSet set;
    for_each([&](std::int64_t n) {
        if (wanted(n)) set.append(n, n + 1);
    });
    return set;
}

FrameSet FrameSet::united_with(const FrameSet& other) const {
    std::vector<Run> all = runs_;
    all.insert(all.end(), other.runs_.begin(), other.runs_.end());
    std::ranges::sort(all, {}, &Run::first);
    FrameSet set;
    for (const Run& run : all) set.append(std::max(run.first, set.end()), run.end);
    return set;
}

std::string FrameSet::text(std::size_t most) const {
    std::string text;
    for (std::size_t i = 0; i < runs_.size() && i < most; ++i) {
        const auto& [first, end] = runs_[i];
        if (i > 0) text += ',';
        text += end - first == 1 ? fmt::format("{}", first) : fmt::format("{}-{}", first, end - 1);
    }
    return runs_.size() > most ? text + ",..." : text;
}

FrameSet read_frame_set(std::string_view text, std::int64_t frame_count) {
    std::vector<Piece> pieces;
    for (std::size_t first = 0; first <= text.size();) {
        const std::size_t end = std::min(text.find(',', first), text.size());
        pieces.push_back(read_piece(without_spaces(text.substr(first, end - first))));
        if (pieces.back().last >= frame_count)
            fail_range(fmt::format("the clip's last frame is {} (given '{}')", frame_count - 1,
                                   safe_text(pieces.back().text)));
        first = end + 1;
    }
    std::ranges::sort(pieces, {}, &Piece::first);
    FrameSet set;
    const Piece* before = nullptr;
    for (const Piece& piece : pieces) {
        if (before != nullptr && piece.first <= before->last)
            fail_range(fmt::format("ranges must not overlap ('{}' and '{}' do)", safe_text(before->text),
                                   safe_text(piece.text)));
        if (piece.step == 1)
            set.append(piece.first, piece.last + 1);
        else
            for (std::int64_t n = piece.first; n <= piece.last; n += piece.step) set.append(n, n + 1);
        before = &piece;
    }
    return set;
}

}  // namespace tumble
