#include "app/lesson/course.h"
#include "app/lesson/course_json.h"
#include "app/lesson/lesson_compiler.h"
#include "core/safe_text.h"
#include "output/process.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <span>

namespace tumble {

const SourceLocation& BlockPlaces::of(const std::string& key) const {
    const auto found = keys.find(key);
    return found == keys.end() ? block : found->second;
}

namespace {

/// A file without a name, for the output of a program of any length.
class OutputInMemory {
public:
    OutputInMemory() : file_(::memfd_create("lessons", MFD_CLOEXEC)) {
        if (file_ < 0) throw RunError(fmt::format("cannot make a file in memory: {}", std::strerror(errno)));
    }
    ~OutputInMemory() { ::close(file_); }
    OutputInMemory(const OutputInMemory&) = delete;
    OutputInMemory& operator=(const OutputInMemory&) = delete;

    int descriptor() const { return file_; }

    std::string text() const {
        struct stat status {};
        ::fstat(file_, &status);
        std::string text(std::size_t(status.st_size), '\0');
        for (std::size_t at = 0; at < text.size();) {
            const ssize_t count = ::pread(file_, text.data() + at, text.size() - at, off_t(at));
            if (count <= 0) throw RunError("cannot read the output of node");
            at += std::size_t(count);
        }
        return text;
    }

private:
    int file_;
};

}  // namespace

std::string run_lesson_compiler(const std::filesystem::path& web_folder, const std::vector<std::string>& arguments,
                                const std::string& input) {
    const std::filesystem::path compiler = web_folder / "lesson.cjs";
    if (!std::filesystem::exists(compiler))
        throw RunError(fmt::format("{} is missing: run scripts/build-web again", safe_path(compiler)));
    const auto node = find_program("node");
    if (!node)
        throw RunError(
            "lessons need Node.js 18.13 or later, and there is no program 'node' on the PATH (Debian: apt-get "
            "install nodejs)");
    std::vector<std::string> command{compiler.string()};
    command.insert(command.end(), arguments.begin(), arguments.end());
    // It ends with this process, which may be killed.
    command.insert(command.end(), {"--for", std::to_string(::getpid())});
    const OutputInMemory output;
    Process process(*node, command, output.descriptor());
    process.write(std::as_bytes(std::span(input)));
    const ProcessEnd end = process.finish();
    if (!end.ok())
        throw RunError(fmt::format("node {}: {}\n{}", safe_path(compiler), end.describe(), safe_lines(end.error_text)));
    return output.text();
}

Course compile_lessons(const std::vector<std::filesystem::path>& files, const std::filesystem::path& web_folder) {
    nlohmann::json list = nlohmann::json::array();
    for (const auto& file : files) list.push_back(file.string());
    return read_course(
        run_lesson_compiler(web_folder, {}, list.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)));
}

}  // namespace tumble
