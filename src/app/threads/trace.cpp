#include "app/threads/trace.h"

#include "output/temporary_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

using Json = nlohmann::ordered_json;

constexpr int process = 1;  // the format wants one; the rows tell the threads apart

/// Whole nanoseconds as microseconds, the unit of the format.
double microseconds(double seconds) { return std::round(1e9 * seconds) / 1e3; }

}  // namespace

void Trace::add(const TraceSpan& span) {
    const std::lock_guard lock(mutex_);
    const auto known = rows_.find(std::this_thread::get_id());
    const std::size_t row =
        known != rows_.end() ? known->second : (rows_[std::this_thread::get_id()] = make_row(span.name));
    spans_.push_back({span, row});
}

void Trace::add(const TraceSpan& span, const std::string& row) {
    const std::lock_guard lock(mutex_);
    const auto known = std::ranges::find(row_names_, row);
    spans_.push_back({span, known != row_names_.end() ? std::size_t(known - row_names_.begin()) : make_row(row)});
}

/// "PNG files", then "PNG files 2".
std::size_t Trace::make_row(const std::string& name) {
    std::string own = name;
    for (int n = 2; std::ranges::find(row_names_, own) != row_names_.end(); ++n) own = fmt::format("{} {}", name, n);
    row_names_.push_back(std::move(own));
    return row_names_.size() - 1;
}

void Trace::write(const std::filesystem::path& file) const {
    const std::lock_guard lock(mutex_);
    double first = spans_.empty() ? 0.0 : spans_.front().span.start;
    for (const Placed& placed : spans_) first = std::min(first, placed.span.start);
    Json events = Json::array();
    events.push_back(
        {{"ph", "M"}, {"name", "process_name"}, {"pid", process}, {"tid", 0}, {"args", {{"name", "tumble"}}}});
    for (std::size_t row = 0; row < row_names_.size(); ++row) {
        events.push_back({{"ph", "M"},
                          {"name", "thread_name"},
                          {"pid", process},
                          {"tid", row + 1},
                          {"args", {{"name", row_names_[row]}}}});
        events.push_back({{"ph", "M"},
                          {"name", "thread_sort_index"},
                          {"pid", process},
                          {"tid", row + 1},
                          {"args", {{"sort_index", row}}}});
    }
    for (const auto& [span, row] : spans_) {
        Json event{{"ph", "X"},
                   {"name", span.name},
                   {"pid", process},
                   {"tid", row + 1},
                   {"ts", microseconds(span.start - first)},
                   {"dur", microseconds(span.end - span.start)}};
        if (span.frame >= 0) event["args"] = {{"frame", span.frame}};
        events.push_back(std::move(event));
    }
    write_file(file, Json{{"displayTimeUnit", "ms"}, {"traceEvents", std::move(events)}}.dump() + "\n");
}

}  // namespace tumble
