#include "output/output_path.h"

#include "core/error.h"
#include "core/safe_text.h"

#include <fmt/format.h>
#include <linux/magic.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
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

void make_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (!error && !std::filesystem::is_directory(folder, error) && !error)
        error = std::make_error_code(std::errc::not_a_directory);
    if (error) throw RunError(fmt::format("cannot make the folder '{}': {}", safe_path(folder), error.message()));
}

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& path, const std::string& problem) {
    throw InputError(fmt::format("cannot write '{}': {}", safe_path(path), problem));
}

bool lies_in(const fs::path& path, const fs::path& folder) {
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

class Confinement {
public:
    Confinement(const fs::path& folder, InnerLinks links) : folder_(folder), links_(links) {
        std::error_code missing;
        real_ = fs::canonical(folder, missing);
    }

    /// A folder on the way to the output; one that is missing will be made.
    void check_folder(const fs::path& path) const {
        std::error_code error;
        if (fs::is_symlink(fs::symlink_status(path, error))) check_link(path, fs::canonical(path, error));
    }

    void check_file(const fs::path& path) const {
        std::error_code error;
        if (fs::is_symlink(fs::symlink_status(path, error))) {
            const fs::path target = output_target(path).path;
            const fs::path parent = target.has_parent_path() ? target.parent_path() : fs::path(".");
            const fs::path real = fs::canonical(parent, error);
            check_link(path, error ? fs::path() : real / target.filename());
        }
        const fs::file_status status = fs::status(path, error);
        if (fs::exists(status) && !fs::is_regular_file(status)) refuse(path, "it is no regular file");
    }

private:
    /// `real`: the place that it leads to; empty: nowhere.
    void check_link(const fs::path& path, const fs::path& real) const {
        if (links_ == InnerLinks::refused) refuse(path, "it is a link");
        if (real.empty() || real_.empty() || !lies_in(real, real_))
            refuse(path, fmt::format("it is a link that leads out of '{}'", safe_path(folder_)));
    }

    fs::path folder_, real_;
    InnerLinks links_;
};

}  // namespace

fs::path confined_path(const fs::path& folder, const fs::path& name, InnerLinks links) {
    if (name.empty() || name.is_absolute() || std::find(name.begin(), name.end(), "..") != name.end())
        refuse(folder / name, fmt::format("it is not below '{}'", safe_path(folder)));
    const Confinement confinement(folder, links);
    fs::path path = folder;
    for (auto part = name.begin(); part != name.end(); ++part) {
        path /= *part;
        if (std::next(part) == name.end())
            confinement.check_file(path);
        else
            confinement.check_folder(path);
    }
    return path;
}

}  // namespace tumble
