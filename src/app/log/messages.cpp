#include "app/log/messages.h"

#include "app/threads/stage_timer.h"
#include "core/error.h"
#include "core/safe_text.h"
#include "tumble/error.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <new>
#include <string>

namespace tumble {
namespace {

using Json = nlohmann::ordered_json;

constexpr double time_digits = 1e6;  // of a second, in the log

double rounded(double seconds) { return std::round(seconds * time_digits) / time_digits; }

/// Like standard error: a log that cannot be written does not stop the run.
void write_line(int descriptor, std::string_view line) {
    while (!line.empty()) {
        const ssize_t written = ::write(descriptor, line.data(), line.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return;
        line.remove_prefix(std::size_t(written));
    }
}

std::string_view without_newlines(std::string_view text) {
    while (text.ends_with('\n')) text.remove_suffix(1);
    return text;
}

/// Text for the terminal: with "error: ".
std::string text_of(const std::exception& error) {
    if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr) return "error: out of memory";
    const bool ours = dynamic_cast<const InputError*>(&error) != nullptr ||
                      dynamic_cast<const RunError*>(&error) != nullptr ||
                      dynamic_cast<const v0::Error*>(&error) != nullptr;
    return ours ? error.what() : "error: " + safe_lines(error.what());
}

Json members_of(const std::exception& error) {
    if (const auto* input = dynamic_cast<const InputError*>(&error)) {
        Json members{{"kind", "input"}, {"text", input->message()}};
        const SourceLocation& where = input->where();
        if (!where.file.empty()) members["file"] = where.file;
        if (where.line > 0) members["line"] = where.line;
        if (where.column > 0) members["column"] = where.column;
        return members;
    }
    return {{"kind", is_input_error(error) ? "input" : "run"}, {"text", reason_of(text_of(error))}};
}

}  // namespace

bool is_input_error(const std::exception& error) {
    const auto* from_library = dynamic_cast<const v0::Error*>(&error);
    return from_library != nullptr ? from_library->kind() == v0::ErrorKind::input
                                   : dynamic_cast<const InputError*>(&error) != nullptr;
}

Messages::Messages() : start_(wall_seconds()) {}

void Messages::write_json_to(int descriptor) {
    const int flags = ::fcntl(descriptor, F_GETFL);
    if (flags < 0 || (flags & O_ACCMODE) == O_RDONLY)
        throw InputError(
            fmt::format("--log-fd: descriptor {} is not open for writing; open it in the shell, as in "
                        "{}>log.jsonl",
                        descriptor, descriptor));
    json_to_ = descriptor;
}

void Messages::say_text(std::string_view text) {
    if (!json()) {
        std::fwrite(text.data(), 1, text.size(), stderr);
        std::fflush(stderr);
        return;
    }
    text = without_newlines(text);
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        event("message", {{"text", text.substr(0, end)}});
        text.remove_prefix(std::min(end + 1, text.size()));
    }
}

void Messages::fail(const std::exception& error) {
    if (json())
        event("error", members_of(error));
    else
        say_text(text_of(error) + "\n");
}

void Messages::event(std::string_view name, const Json& members) {
    if (!json()) return;
    Json line{{"event", name}, {"t", rounded(wall_seconds() - start_)}};
    line.update(members);
    // Names of files may hold any bytes.
    write_line(json_to_, line.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
}

void Messages::end(int exit_code) { event("end", {{"exit_code", exit_code}}); }

void Messages::progress(const ProgressFigures& figures) {
    if (!json()) return;
    const double rate = figures.seconds > 0.0 ? double(figures.done) / figures.seconds : 0.0;
    Json members{{"done", figures.done},
                 {"total", figures.total},
                 {"of", figures.things},
                 {"seconds", rounded(figures.seconds)}};
    if (rate > 0.0) {
        members["per_second"] = rounded(rate);
        members["seconds_left"] = rounded(double(figures.total - figures.done) / rate);
    }
    event("progress", members);
}

}  // namespace tumble
