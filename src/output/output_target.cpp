#include "output/output_target.h"

#include "core/error.h"
#include "core/safe_text.h"

#include <fmt/format.h>

#include <linux/magic.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <charconv>
#include <string>
#include <system_error>

namespace tumble {
namespace {

namespace fs = std::filesystem;

constexpr int most_links = 40;  // Linux's own limit

std::optional<int> whole_number(const std::string& text) {
    int number = 0;
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, number);
    if (text.empty() || error != std::errc() || end != last || number < 0) return std::nullopt;
    return number;
}

fs::path folder_of(const fs::path& name) { return name.has_parent_path() ? name.parent_path() : fs::path("."); }

/// True for the folder of the descriptors of this process (/proc/self/fd, also of one of its threads).
bool lists_our_descriptors(const fs::path& folder) {
    std::error_code error;
    const std::string self = fs::canonical("/proc/self", error).string();
    if (error) return false;
    const std::string there = fs::canonical(folder, error).string();
    return !error && there.starts_with(self + "/") && there.ends_with("/fd");
}

/// The descriptor that a name stands for directly.
std::optional<int> descriptor_named(const fs::path& name) {
    if (name == "/dev/stdout") return STDOUT_FILENO;  // also without /proc, which the link leads to
    if (name == "/dev/stderr") return STDERR_FILENO;
    const auto number = whole_number(name.filename().string());
    return number && lists_our_descriptors(folder_of(name)) ? number : std::nullopt;
}

bool is_in_proc(const fs::path& name) {
    struct statfs system {};
    return ::statfs(folder_of(name).c_str(), &system) == 0 && system.f_type == PROC_SUPER_MAGIC;
}

bool is_device_or_pipe(const fs::path& name) {
    std::error_code ignored;
    const fs::file_status status = fs::status(name, ignored);
    return fs::is_character_file(status) || fs::is_fifo(status) || fs::is_socket(status) || fs::is_block_file(status);
}

}  // namespace

OutputTarget output_target(const fs::path& name) {
    OutputTarget target{name, std::nullopt, false};
    for (int i = 0; i <= most_links; ++i) {
        std::error_code error;
        target.descriptor = descriptor_named(target.path);
        if (target.descriptor || !fs::is_symlink(fs::symlink_status(target.path, error))) {
            target.in_place = target.descriptor || is_device_or_pipe(target.path);
            return target;
        }
        // A link to another process's descriptor names the file, but the descriptor is meant.
        if (is_in_proc(target.path)) {
            target.in_place = true;
            return target;
        }
        const fs::path next = fs::read_symlink(target.path, error);
        if (error) return target;  // opening it will give the same error
        target.path = next.is_absolute() ? next : target.path.parent_path() / next;
    }
    throw InputError(fmt::format("cannot write '{}': its links form a loop", safe_path(name)));
}

}  // namespace tumble
